"""A private ROS domain on this machine, and the environment variables for it."""

from __future__ import annotations

import os
import socket
import sys
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from blocks_planning.errors import ConfigurationError, LimitExceeded
from blocks_planning.resources import resource_directories

DOMAINS = range(1, 101)
_CLAIM_PORT = 6900  # a socket on this port + domain marks the domain as taken


class Domain:
    """A claimed domain; it is free again when this object is released or the process ends."""

    def __init__(self, number: int | None = None) -> None:
        """Claim a domain; None: any free one.

        Raises:
            ConfigurationError: if the number is not 0 to 100.
            LimitExceeded: if every domain is claimed.
        """
        if number is not None and not 0 <= number <= DOMAINS[-1]:
            raise ConfigurationError(f'domain must be from 0 to {DOMAINS[-1]}, got {number}')
        self._claim: socket.socket | None = None
        self.number = self._find_free() if number is None else number

    def _find_free(self) -> int:
        # Bring-ups begin the search at different domains, so that they rarely collide with a domain
        # that was set by hand.
        start = os.getpid() % len(DOMAINS)
        for number in (*DOMAINS[start:], *DOMAINS[:start]):
            claim = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            with suppress(OSError):
                claim.bind(('127.0.0.1', _CLAIM_PORT + number))
                self._claim = claim
                return number
            claim.close()
        raise LimitExceeded(f'all ROS domains from 1 to {DOMAINS[-1]} are taken on this machine')

    def release(self) -> None:
        """Free the domain."""
        if self._claim is not None:
            self._claim.close()

    def environment(self, base: Mapping[str, str]) -> dict[str, str]:
        """The environment variables of a process in this domain, on this machine only."""
        return {
            **base,
            'AMENT_PREFIX_PATH': base.get('AMENT_PREFIX_PATH') or sys.prefix,
            'ROS_DOMAIN_ID': str(self.number),
            'ROS_AUTOMATIC_DISCOVERY_RANGE': 'SYSTEM_DEFAULT',
            'FASTRTPS_DEFAULT_PROFILES_FILE': str(loopback_profile()),
            'RMW_FASTRTPS_USE_QOS_FROM_XML': '1',  # that profile sets how memory is allocated
            'RMW_IMPLEMENTATION': 'rmw_fastrtps_cpp',
        }


def loopback_profile() -> Path:
    """The Fast DDS profile that keeps everything on this machine.

    Raises:
        ConfigurationError: if the file was not installed.
    """
    for directory in resource_directories('config'):
        path = directory / 'loopback.xml'
        if path.is_file():
            return path
    raise ConfigurationError('config/loopback.xml is missing: install the package again')
