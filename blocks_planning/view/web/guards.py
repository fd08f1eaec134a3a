"""Who may look at the page, and who may say something on it.

A page of another origin must not be able to talk to this one through the browser of a person who
has both open. So a request must name this server as its host (or a foreign name could be made to
point here), and whatever changes something, or opens a socket, must come from this page. Off the
loopback a token is asked for as well.
"""

from __future__ import annotations

import ipaddress
import secrets
import socket
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass
from http.cookies import CookieError, SimpleCookie
from urllib.parse import urlsplit

from blocks_planning.errors import ConfigurationError

HEADERS: Mapping[str, str] = {
    'Content-Security-Policy': "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self'; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'",
    'X-Content-Type-Options': 'nosniff',
    'X-Frame-Options': 'DENY',
    'Referrer-Policy': 'no-referrer',
    'Cross-Origin-Opener-Policy': 'same-origin',
    'Cross-Origin-Resource-Policy': 'same-origin',
    'Cache-Control': 'no-store',
    'Server': 'blocks_planning',
}
"""Of every answer."""
LEAST_TOKEN = 16
_MOST_CLIENTS = 1000


@dataclass(frozen=True)
class Address:
    """Where the page is.

    Attributes:
        host: name or number to listen at.
        port: to listen at; 0 before it is known.
        token: to be shown by who looks; '' for none.

    Raises:
        ConfigurationError: if the token is short, or there is none off the loopback.
    """

    host: str = '127.0.0.1'
    port: int = 0
    token: str = ''

    def __post_init__(self) -> None:
        if self.token and (len(self.token) < LEAST_TOKEN or not _is_plain(self.token)):
            raise ConfigurationError(
                f'token must be {LEAST_TOKEN} or more letters, digits, _ and -, '
                f'got {len(self.token)} characters'
            )
        if not self.token and not self.is_loopback:
            raise ConfigurationError(f'host {self.host!r} is not this machine alone: give a token')

    @property
    def is_loopback(self) -> bool:
        """Whether only programs on this machine can reach it."""
        return is_loopback(self.host)

    @property
    def url(self) -> str:
        """What to type into a browser; it holds the token."""
        place = f'http://{_bracketed(_shown_host(self.host))}:{self.port}/'
        return f'{place}?token={self.token}' if self.token else place

    @property
    def cookie(self) -> str:
        """Name of the cookie that holds the token; the ports of a host share their cookies."""
        return f'blocks_planning_{self.port}'

    def is_host(self, header: str | None) -> bool:
        """Whether a Host header names this server.

        A number is never a foreign name that was made to point here.
        """
        name, port = _split(header)
        if name is None or port != self.port:
            return False
        if self.is_loopback:
            return name in {'localhost', '127.0.0.1', '::1', self.host.lower()}
        return _is_number(name) or name in {self.host.lower(), socket.gethostname().lower()}

    def is_token(self, given: str | None) -> bool:
        """Whether a token is the right one; compared in a time that says nothing."""
        return given is not None and secrets.compare_digest(given.encode(), self.token.encode())

    def is_admitted(self, cookies: str | None) -> bool:
        """Whether a Cookie header holds the token, if one is asked for."""
        if not self.token:
            return True
        try:
            morsel = SimpleCookie(cookies or '').get(self.cookie)
        except CookieError:
            return False
        return morsel is not None and self.is_token(morsel.value)


def address_of(host: str, port: int, token: str = '') -> Address:
    """An address, with a new token if one is needed and none is given."""
    if not token and not is_loopback(host):
        token = secrets.token_urlsafe(32)
    return Address(host, port, token)


def is_loopback(host: str) -> bool:
    """Whether a name or number is of this machine alone."""
    if host == 'localhost':
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def is_same_origin(origin: str | None, host: str | None) -> bool:
    """Whether an Origin header names the server that a Host header names."""
    return bool(origin) and bool(host) and urlsplit(origin or '').netloc.lower() == _lower(host)


class RateLimit:
    """So many things at once, and then so many in a second, for each client."""

    def __init__(self, burst: int, per_s: float) -> None:
        """Nobody has done anything yet."""
        self._burst = burst
        self._per_s = per_s
        self._left: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def allows(self, client: str, now_s: float) -> bool:
        """Whether a client may do another thing at a time of a steady clock [s]."""
        left, since_s = self._left.pop(client, (float(self._burst), now_s))
        left = min(self._burst, left + (now_s - since_s) * self._per_s)
        allowed = left >= 1
        self._left[client] = (left - allowed, now_s)
        while len(self._left) > _MOST_CLIENTS:
            self._left.popitem(last=False)
        return allowed


def _is_plain(token: str) -> bool:
    return token.isascii() and token.replace('_', '').replace('-', '').isalnum()


def _lower(text: str | None) -> str:
    return (text or '').lower()


def _is_number(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _bracketed(name: str) -> str:
    return f'[{name}]' if ':' in name else name


def _shown_host(host: str) -> str:
    """A host that others can type: not the one that stands for all."""
    return socket.gethostname() if host in ('0.0.0.0', '::') else host


def _split(header: str | None) -> tuple[str | None, int | None]:
    """Name and port of a Host header."""
    try:
        parts = urlsplit(f'//{header or ""}')
        if parts.path or parts.query or parts.fragment or parts.username is not None:
            return None, None
        return parts.hostname, 80 if parts.port is None else parts.port
    except ValueError:
        return None, None
