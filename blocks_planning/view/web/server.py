"""The server of the live page.

It reads the state to show from a mailbox; see :mod:`.live`. It forwards the proposals of a person
and waits for the answers.
"""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path
from typing import Any

from blocks_planning.extras import extra
from blocks_planning.subgoals.drawn import Refused
from blocks_planning.view.web.frame import hides_costs
from blocks_planning.view.web.guards import Address, RateLimit
from blocks_planning.view.web.live import Audience, Mailbox
from blocks_planning.view.web.pictures import replay_json, summary_json
from blocks_planning.view.web.serving import FAREWELL_S, SOCKET, Server, refusal, sender

with extra('page'):
    from aiohttp import web

MOST_CLIENTS = 16
MOST_REPLAYS = 5
"""Number of replays in one response."""
_BURST, _PER_S = 20, 5.0
_ANSWER_S = 5.0
_HEARTBEAT_S = 10.0
STATIC = Path(__file__).with_name('static')

Propose = Callable[[Any], 'Future[Refused | None]']


class PageServer(Server):
    """Serves the content of a mailbox; at the end every browser is told that it is over."""

    def __init__(self, address: Address, mailbox: Mailbox, propose: Propose) -> None:
        """Prepare the server.

        Args:
            address: to listen on.
            mailbox: holds the state to show.
            propose: called, in the server's thread, with a person's proposal, decoded from JSON.
                Its future gives the reason of a refusal, or None; it raises InvalidInput for
                malformed data.
        """
        super().__init__(address)
        self._mailbox = mailbox
        self._propose = propose
        self._audience = Audience(mailbox)
        self._limit = RateLimit(_BURST, _PER_S)

    @property
    def clients(self) -> int:
        """Number of connected browsers."""
        return len(self._audience)

    def add_routes(self, router: web.UrlDispatcher) -> None:
        """See :class:`Server`."""
        router.add_get('/', sender(STATIC / 'index.html'))
        for path in STATIC.iterdir():
            if path.suffix != '.html':
                router.add_get(f'/{path.name}', sender(path))
        router.add_get(SOCKET, self._live)
        router.add_get('/trials', self._trials)
        router.add_get('/replays', self._replays)
        router.add_post('/proposal', self._proposal)

    async def work(self) -> None:
        """See :class:`Server`."""
        await self._audience.broadcast()

    async def say_farewell(self) -> None:
        """See :class:`Server`."""
        await self._audience.say_farewell()

    # From the server to the page

    async def _live(self, request: web.Request) -> web.StreamResponse:
        """A socket that sends frames."""
        if len(self._audience) >= MOST_CLIENTS:
            return refusal(503, 'clients', f'{MOST_CLIENTS} browsers are connected already')
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
            return refusal(429, 'rate', 'too many proposals at once: wait a second')
        if request.content_type != 'application/json':
            return refusal(415, 'type', 'expected application/json')
        try:
            data = json.loads(await request.text())
        except (ValueError, RecursionError):
            return refusal(400, 'json', 'the request is not JSON')
        answer = asyncio.wrap_future(self._propose(data))
        try:
            refused = await asyncio.wait_for(answer, _ANSWER_S)
        except asyncio.TimeoutError:
            return refusal(504, 'busy', 'the graph does not answer: try again')
        except ValueError as error:
            return refusal(400, 'malformed', str(error))
        if refused is not None:
            return refusal(409 if refused.code in ('stale', 'waiting') else 422, *refused)
        return web.json_response({'taken': True})


def _number(request: web.Request, key: str) -> int:
    text = request.query.get(key, '0')
    if not text.isdecimal() or len(text) > 9:
        raise web.HTTPBadRequest(reason=f'{key} must be a number')
    return int(text)
