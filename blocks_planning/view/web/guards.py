"""Access control of the page.

A page of another origin must not send requests to this server through the browser of a person who
has both pages open. So the Host header of a request must name this server (this prevents DNS
rebinding), and a request that changes something, or opens a socket, must have this page as its
origin. An address other than the loopback also requires a token.
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
"""Headers of every response."""
LEAST_TOKEN = 16
_MOST_CLIENTS = 1000


@dataclass(frozen=True)
class Address:
    """The address of the page.

    Attributes:
        host: host name or IP address to listen on.
        port: port to listen on; 0 before it is known.
        token: access token that every browser must present; '' for none.
        page: path of the page below the host, without '/'.

    Raises:
        ConfigurationError: if the token is too short, or is missing for an address other than the
            loopback.
    """

    host: str = '127.0.0.1'
    port: int = 0
    token: str = ''
    page: str = ''

    def __post_init__(self) -> None:
        if self.token and (len(self.token) < LEAST_TOKEN or not _is_plain(self.token)):
            raise ConfigurationError(
                f'token must be {LEAST_TOKEN} or more letters, digits, _ and -, '
                f'got {len(self.token)} characters'
            )
        if not self.token and not self.is_loopback:
            raise ConfigurationError(
                f'host {self.host!r} can be reached from other machines: set a token'
            )

    @property
    def is_loopback(self) -> bool:
        """Whether only programs on this machine can reach it."""
        return is_loopback(self.host)

    @property
    def url(self) -> str:
        """The URL to open in a browser, with the token."""
        place = f'http://{_bracketed(_shown_host(self.host))}:{self.port}/{self.page}'
        return f'{place}?token={self.token}' if self.token else place

    @property
    def cookie(self) -> str:
        """Name of the cookie that holds the token; the ports of a host share their cookies."""
        return '_'.join(filter(None, ['blocks_planning', str(self.port), self.page]))

    def is_host(self, header: str | None) -> bool:
        """Whether a Host header names this server.

        An IP address is accepted: DNS rebinding needs a host name.
        """
        name, port = _split(header)
        if name is None or port != self.port:
            return False
        if self.is_loopback:
            return name in {'localhost', '127.0.0.1', '::1', self.host.lower()}
        return _is_number(name) or name in {self.host.lower(), socket.gethostname().lower()}

    def is_token(self, given: str | None) -> bool:
        """Whether a token is correct; compared in constant time."""
        return given is not None and secrets.compare_digest(given.encode(), self.token.encode())

    def is_admitted(self, cookies: str | None) -> bool:
        """Whether a Cookie header holds the token, if one is required."""
        if not self.token:
            return True
        try:
            morsel = SimpleCookie(cookies or '').get(self.cookie)
        except CookieError:
            return False
        return morsel is not None and self.is_token(morsel.value)


def address_of(host: str, port: int, token: str = '') -> Address:
    """An address, with a new token if one is required and none is given."""
    if not token and not is_loopback(host):
        token = new_token()
    return Address(host, port, token)


def is_loopback(host: str) -> bool:
    """Whether a host name or IP address can be reached from this machine alone."""
    if host == 'localhost':
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def new_token() -> str:
    """A token that nobody guesses."""
    return secrets.token_urlsafe(32)


def is_same_origin(origin: str | None, host: str | None) -> bool:
    """Whether an Origin header names the server that a Host header names."""
    return bool(origin) and bool(host) and urlsplit(origin or '').netloc.lower() == _lower(host)


class RateLimit:
    """A token bucket for each client: a burst, then a rate [1/s]."""

    def __init__(self, burst: int, per_s: float) -> None:
        """Start with a full burst for every client."""
        self._burst = burst
        self._per_s = per_s
        self._left: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def allows(self, client: str, now_s: float) -> bool:
        """Whether a client may send another request at a time of a monotonic clock [s]."""
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
    """A host that a browser can connect to, instead of the wildcard address."""
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
