"""Reservation of a port before the process that listens on it starts."""

from __future__ import annotations

import socket

from blocks_planning.errors import ConfigurationError


class ReservedPort:
    """A reserved port on which another process of this user may listen.

    The socket is bound but never listens, so it does not block a process that does, nor its
    successor after a kill and restart.
    """

    def __init__(self, host: str, port: int = 0) -> None:
        """Reserve a port; 0: any free one.

        Raises:
            ConfigurationError: if the host is not an address of this machine, or the port is taken.
        """
        try:
            self._socket = _bound(host, port)
        except OSError as error:
            raise ConfigurationError(
                f'the page cannot be served at {host}:{port}: {error.strerror}'
            ) from None
        self.number: int = self._socket.getsockname()[1]

    def release(self) -> None:
        """Release the port."""
        self._socket.close()


def _bound(host: str, port: int) -> socket.socket:
    family, kind, protocol, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    made = socket.socket(family, kind, protocol)
    try:
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        made.bind(place)
    except OSError:
        made.close()
        raise
    return made
