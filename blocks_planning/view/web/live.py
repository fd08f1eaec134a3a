"""The connected browsers; each gets the latest frame several times a second.

Frames are dropped, never queued.
"""

from __future__ import annotations

import asyncio
import json
import time

from blocks_planning.extras import extra
from blocks_planning.view.web.frame import Seen, frame_json, hides_costs
from blocks_planning.view.web.pictures import replay_json, summary_json
from blocks_planning.view.web.serving import FAREWELL_S

with extra('page'):
    from aiohttp import WSMsgType, web

FRAME_S = 0.1
"""Shortest time between frames [s]."""
QUIET_S = 1.0
"""Period of frames if nothing has changed [s]."""
FAREWELL_REPLAYS = 20
"""Number of replays that a browser gets at the end, as it cannot fetch them later."""


class Mailbox:
    """The latest state to show. One thread writes it, others read it, without locks."""

    def __init__(self) -> None:
        """Start with an empty state."""
        self.seen = Seen()

    def put(self, seen: Seen) -> None:
        """Replace the state; states are immutable."""
        self.seen = seen


class _Client:
    """A connected browser: it gets the latest frame, and skips frames that it is too slow for."""

    def __init__(self, socket: web.WebSocketResponse) -> None:
        self._socket = socket
        self._latest: str | None = None
        self._has_news = asyncio.Event()

    def offer(self, frame: str) -> None:
        self._latest = frame
        self._has_news.set()

    async def send(self) -> None:
        """Send the offered frames, as fast as the browser accepts them."""
        while True:
            await self._has_news.wait()
            self._has_news.clear()
            frame, self._latest = self._latest, None
            if frame is not None:
                await self._socket.send_str(frame)

    async def say_farewell(self, frame: str) -> None:
        await self._socket.send_str(frame)
        await self._socket.close(code=1001)


class Audience:
    """All connected browsers; the one-way part of the server."""

    def __init__(self, mailbox: Mailbox) -> None:
        """Start without browsers."""
        self._mailbox = mailbox
        self._clients: set[_Client] = set()

    def __len__(self) -> int:
        return len(self._clients)

    async def join(self, socket: web.WebSocketResponse, request: web.Request) -> None:
        """Send frames on a socket until it is closed; incoming messages close it."""
        client = _Client(socket)
        self._clients.add(client)
        try:
            await socket.prepare(request)
            client.offer(self._frame('frame'))
            sending = asyncio.create_task(client.send())
            try:
                async for message in socket:
                    if message.type in (WSMsgType.TEXT, WSMsgType.BINARY):
                        await socket.close(code=1003)
            finally:
                sending.cancel()
        finally:
            self._clients.discard(client)

    async def broadcast(self) -> None:
        """Offer every new frame to all browsers; encode each frame once."""
        shown, shown_s = None, 0.0
        while True:
            await asyncio.sleep(FRAME_S)
            seen, now_s = self._mailbox.seen, time.monotonic()
            if self._clients and (seen is not shown or now_s - shown_s >= QUIET_S):
                shown, shown_s = seen, now_s
                frame = self._frame('frame')
                for client in self._clients:
                    client.offer(frame)

    def _frame(self, kind: str, **more: object) -> str:
        frame = frame_json(self._mailbox.seen, time.monotonic())
        return json.dumps({**frame, 'kind': kind, **more}, separators=(',', ':'))

    async def say_farewell(self) -> None:
        """Tell every browser that the session is over, and send the last trials."""
        if not self._clients:
            return
        session = self._mailbox.seen.session
        hidden = hides_costs(session)
        last = session.past[-FAREWELL_REPLAYS:]
        frame = self._frame(
            'over',
            trials=[summary_json(past, hidden) for past in last],
            replays=[replay_json(past, hidden) for past in last],
        )
        farewells = [client.say_farewell(frame) for client in self._clients]
        done = asyncio.gather(*farewells, return_exceptions=True)
        await asyncio.wait([done], timeout=FAREWELL_S)
