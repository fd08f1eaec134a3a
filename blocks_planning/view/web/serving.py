"""A server in its own thread with its own event loop, and who is let in.

The routes are those of a subclass. See :mod:`.guards` for what a request must have.
"""

from __future__ import annotations

import asyncio
import threading
from abc import ABC, abstractmethod
from collections.abc import Awaitable, Callable
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path

from blocks_planning.errors import ConfigurationError
from blocks_planning.extras import extra
from blocks_planning.view.web.guards import HEADERS, Address, is_same_origin

with extra('page'):
    from aiohttp import web

SOCKET = '/live'
"""Path of a server's socket: like what changes something, only its own page may open it."""
MOST_BYTES = 16 * 1024
"""Size limit of a request."""
FAREWELL_S = 0.25
"""Time limit for the last words to browsers [s]."""
_START_S = 20.0
_KINDS = {
    '.html': 'text/html',
    '.js': 'text/javascript',
    '.css': 'text/css',
    '.svg': 'image/svg+xml',
}

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class Server(ABC):
    """Serves pages at an address.

    Attributes:
        address: of the first page; has its port after the start.
        public: paths that need no token: files of the package, which are no secret.
    """

    public: frozenset[str] = frozenset()

    def __init__(self, address: Address) -> None:
        """Prepare the server; :meth:`start` starts it."""
        self.address = address
        self._loop: asyncio.AbstractEventLoop | None = None
        self._end: asyncio.Event | None = None
        self._started: Future[int] = Future()
        self._thread = threading.Thread(target=self._run, name='page', daemon=True)

    @abstractmethod
    def add_routes(self, router: web.UrlDispatcher) -> None:
        """Add the routes of the server."""

    @abstractmethod
    async def work(self) -> None:
        """Work beside the requests, until it is cancelled."""

    @abstractmethod
    async def say_farewell(self) -> None:
        """The last that is done before the server ends."""

    def door(self, path: str) -> Address:
        """The address whose token a request for a path needs."""
        return self.address

    def start(self) -> None:
        """Start to listen.

        Raises:
            ConfigurationError: if the server cannot listen on the address.
        """
        self._thread.start()
        try:
            port = self._started.result(_START_S)
        except OSError as error:
            place = f'{self.address.host}:{self.address.port}'
            reason = error.strerror or str(error)
            raise ConfigurationError(f'the page cannot be served at {place}: {reason}') from None
        self.take_port(port)

    def take_port(self, port: int) -> None:
        """The server listens to a port."""
        self.address = replace(self.address, port=port)

    def stop(self) -> None:
        """End, after :meth:`say_farewell`."""
        if self._loop is not None and self._end is not None and self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._end.set)
            self._thread.join(2 * FAREWELL_S)

    def _run(self) -> None:
        try:
            asyncio.run(self._serve())
        except BaseException as error:
            if self._started.done():
                raise
            self._started.set_exception(error)

    async def _serve(self) -> None:
        self._loop, self._end = asyncio.get_running_loop(), asyncio.Event()
        runner = web.AppRunner(
            self.application(), access_log=None, shutdown_timeout=FAREWELL_S, handle_signals=False
        )
        await runner.setup()
        try:
            await web.TCPSite(runner, self.address.host, self.address.port).start()
            port = runner.addresses[0][1]
            self.take_port(port)
            self._started.set_result(port)
            working = asyncio.create_task(self.work())
            await self._end.wait()
            working.cancel()
            await self.say_farewell()
        finally:
            await runner.cleanup()

    def application(self) -> web.Application:
        """The application, with its routes."""
        application = web.Application(middlewares=[self._guard], client_max_size=MOST_BYTES)
        application.on_response_prepare.append(_add_headers)
        self.add_routes(application.router)
        return application

    @web.middleware
    async def _guard(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        """Refuse requests without access; see :mod:`.guards`."""
        headers, door = request.headers, self.door(request.path)
        if not door.is_host(headers.get('Host')):
            return refusal(403, 'host', 'the Host header does not name this server')
        if door.token and request.path == f'/{door.page}' and 'token' in request.query:
            return _admission(door, request)
        if request.path not in self.public and not door.is_admitted(headers.get('Cookie')):
            return refusal(401, 'token', 'open the printed address, with its token')
        from_page = is_same_origin(headers.get('Origin'), headers.get('Host'))
        if not from_page and (request.method not in ('GET', 'HEAD') or request.path == SOCKET):
            return refusal(403, 'origin', 'the request does not come from the page')
        try:
            return await handler(request)
        except web.HTTPException as error:
            return refusal(error.status, 'http', error.reason)


def _admission(door: Address, request: web.Request) -> web.StreamResponse:
    """Store the token in a cookie, and redirect to an address without it."""
    if not door.is_token(request.query.get('token')):
        return refusal(401, 'token', 'wrong token: open the printed address')
    page = f'/{door.page}'
    answer = web.Response(status=303, headers={'Location': page})
    answer.set_cookie(door.cookie, door.token, httponly=True, samesite='Strict', path=page)
    return answer


def sender(path: Path) -> Handler:
    """A handler that responds with a file of the package."""
    body = path.read_bytes()

    async def send(_: web.Request) -> web.StreamResponse:
        return web.Response(body=body, content_type=_KINDS[path.suffix], charset='utf-8')

    return send


def refusal(status: int, code: str, reason: str) -> web.Response:
    """A response that refuses a request: a word for programs, a sentence for people."""
    return web.json_response({'code': code, 'reason': reason}, status=status)


async def _add_headers(_: web.Request, response: web.StreamResponse) -> None:
    response.headers.update(HEADERS)
