"""The server of the page: its own thread with its own event loop.

It reads the state to show from a mailbox; see :mod:`.live`. It forwards the proposals of a person
and waits for the answers.
"""

from __future__ import annotations

import asyncio
import json
import threading
import time
from collections.abc import Awaitable, Callable
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path
from typing import Any

from blocks_planning.errors import ConfigurationError
from blocks_planning.extras import extra
from blocks_planning.subgoals.drawn import Refused
from blocks_planning.view.web.frame import hides_costs
from blocks_planning.view.web.guards import HEADERS, Address, RateLimit, is_same_origin
from blocks_planning.view.web.live import FAREWELL_S, Audience, Mailbox
from blocks_planning.view.web.pictures import replay_json, summary_json

with extra('page'):
    from aiohttp import web

MOST_CLIENTS = 16
MOST_BYTES = 16 * 1024
"""Size limit of a request."""
MOST_REPLAYS = 5
"""Number of replays in one response."""
_BURST, _PER_S = 20, 5.0
_ANSWER_S = 5.0
_HEARTBEAT_S = 10.0
_START_S = 20.0
_STATIC = Path(__file__).with_name('static')
_FILES = {
    '/': ('index.html', 'text/html'),
    **{f'/{path.name}': (path.name, 'text/javascript') for path in _STATIC.glob('*.js')},
    '/style.css': ('style.css', 'text/css'),
    '/icon.svg': ('icon.svg', 'image/svg+xml'),
}

Propose = Callable[[Any], 'Future[Refused | None]']
Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class PageServer:
    """Serves the content of a mailbox.

    Attributes:
        address: of the page; has its port after the start.
    """

    def __init__(self, address: Address, mailbox: Mailbox, propose: Propose) -> None:
        """Prepare the server; :meth:`start` starts it.

        Args:
            address: to listen on.
            mailbox: holds the state to show.
            propose: called, in the server's thread, with a person's proposal, decoded from JSON.
                Its future gives the reason of a refusal, or None; it raises InvalidInput for
                malformed data.
        """
        self.address = address
        self._mailbox = mailbox
        self._propose = propose
        self._audience = Audience(mailbox)
        self._limit = RateLimit(_BURST, _PER_S)
        self._loop: asyncio.AbstractEventLoop | None = None
        self._end: asyncio.Event | None = None
        self._started: Future[int] = Future()
        self._thread = threading.Thread(target=self._run, name='page', daemon=True)

    @property
    def clients(self) -> int:
        """Number of connected browsers."""
        return len(self._audience)

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
        self.address = replace(self.address, port=port)

    def stop(self) -> None:
        """Tell every browser that the session is over, with what is in the mailbox; then end."""
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
            self.address = replace(self.address, port=port)
            self._started.set_result(port)
            broadcasting = asyncio.create_task(self._audience.broadcast())
            await self._end.wait()
            broadcasting.cancel()
            await self._audience.say_farewell()
        finally:
            await runner.cleanup()

    def application(self) -> web.Application:
        """The routes of the server."""
        application = web.Application(middlewares=[self._guard], client_max_size=MOST_BYTES)
        application.on_response_prepare.append(_add_headers)
        for path, (name, kind) in _FILES.items():
            application.router.add_get(path, _sender(_STATIC / name, kind))
        application.router.add_get('/live', self._live)
        application.router.add_get('/trials', self._trials)
        application.router.add_get('/replays', self._replays)
        application.router.add_post('/proposal', self._proposal)
        return application

    @web.middleware
    async def _guard(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        """Refuse requests without access; see :mod:`.guards`."""
        headers = request.headers
        if not self.address.is_host(headers.get('Host')):
            return _refusal(403, 'host', 'the Host header does not name this server')
        if self.address.token and request.path == '/' and 'token' in request.query:
            return self._admission(request)
        if not self.address.is_admitted(headers.get('Cookie')):
            return _refusal(401, 'token', 'open the printed address, with its token')
        from_page = is_same_origin(headers.get('Origin'), headers.get('Host'))
        if not from_page and (request.method not in ('GET', 'HEAD') or request.path == '/live'):
            return _refusal(403, 'origin', 'the request does not come from the page')
        try:
            return await handler(request)
        except web.HTTPException as error:
            return _refusal(error.status, 'http', error.reason)

    def _admission(self, request: web.Request) -> web.StreamResponse:
        """Store the token in a cookie, and redirect to an address without it."""
        if not self.address.is_token(request.query.get('token')):
            return _refusal(401, 'token', 'wrong token: open the printed address')
        answer = web.Response(status=303, headers={'Location': '/'})
        answer.set_cookie(
            self.address.cookie, self.address.token, httponly=True, samesite='Strict', path='/'
        )
        return answer

    # From the server to the page

    async def _live(self, request: web.Request) -> web.StreamResponse:
        """A socket that sends frames."""
        if len(self._audience) >= MOST_CLIENTS:
            return _refusal(503, 'clients', f'{MOST_CLIENTS} browsers are connected already')
        socket = web.WebSocketResponse(
            heartbeat=_HEARTBEAT_S, compress=False, max_msg_size=1024, timeout=FAREWELL_S
        )
        await self._audience.join(socket, request)
        return socket

    async def _trials(self, request: web.Request) -> web.StreamResponse:
        """The finished trials, from a number on."""
        session, first = self._mailbox.seen.session, _number(request, 'from')
        hidden = hides_costs(session)
        found = [summary_json(past, hidden) for past in session.past if past.number >= first]
        return web.json_response(found)

    async def _replays(self, request: web.Request) -> web.StreamResponse:
        """Replays of finished trials, from a number on."""
        session, first = self._mailbox.seen.session, _number(request, 'from')
        hidden = hides_costs(session)
        found = [past for past in session.past if past.number >= first][:MOST_REPLAYS]
        return web.json_response([replay_json(past, hidden) for past in found])

    # From the page to the server

    async def _proposal(self, request: web.Request) -> web.StreamResponse:
        """Forward a person's proposal."""
        if not self._limit.allows(request.remote or '', time.monotonic()):
            return _refusal(429, 'rate', 'too many proposals at once: wait a second')
        if request.content_type != 'application/json':
            return _refusal(415, 'type', 'expected application/json')
        try:
            data = json.loads(await request.text())
        except (ValueError, RecursionError):
            return _refusal(400, 'json', 'the request is not JSON')
        answer = asyncio.wrap_future(self._propose(data))
        try:
            refused = await asyncio.wait_for(answer, _ANSWER_S)
        except asyncio.TimeoutError:
            return _refusal(504, 'busy', 'the graph does not answer: try again')
        except ValueError as error:
            return _refusal(400, 'malformed', str(error))
        if refused is not None:
            return _refusal(409 if refused.code in ('stale', 'waiting') else 422, *refused)
        return web.json_response({'taken': True})


def _sender(path: Path, kind: str) -> Handler:
    """A handler that responds with a file of the package."""
    body = path.read_bytes()

    async def send(_: web.Request) -> web.StreamResponse:
        return web.Response(body=body, content_type=kind, charset='utf-8')

    return send


def _refusal(status: int, code: str, reason: str) -> web.Response:
    return web.json_response({'code': code, 'reason': reason}, status=status)


def _number(request: web.Request, key: str) -> int:
    text = request.query.get(key, '0')
    if not text.isdecimal() or len(text) > 9:
        raise web.HTTPBadRequest(reason=f'{key} must be a number')
    return int(text)


async def _add_headers(_: web.Request, response: web.StreamResponse) -> None:
    response.headers.update(HEADERS)
