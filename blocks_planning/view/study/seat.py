"""The connection of the participant: one page holds the session, any other is refused."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Awaitable, Callable
from typing import Any, NamedTuple

from blocks_planning.extras import extra
from blocks_planning.view.web.guards import RateLimit

with extra('page'):
    from aiohttp import WSMsgType, web

TAKEN, REPLACED = 4001, 4002
"""Codes with which a socket is closed: another page has the seat, or this one came again."""
_HELLO_S = 10.0
_HEARTBEAT_S = 6.0
_MOST_BYTES = 16 * 1024
_BURST, _PER_S = 40, 10.0
Said = dict[str, Any]


class _Sitting(NamedTuple):
    key: str
    socket: web.WebSocketResponse


class Seat:
    """The single connection of the participant's page.

    A page creates a random key and sends it first. A page with the same key is the same page after
    a lost connection.
    """

    def __init__(
        self,
        on_change: Callable[[bool], Awaitable[None]],
        on_message: Callable[[Said], Awaitable[Said | None]],
    ) -> None:
        """Begin without a page.

        Args:
            on_change: called with True when a page connects, with False when it disconnects.
            on_message: called with every message of the page; its result is sent back.
        """
        self._on_change = on_change
        self._on_message = on_message
        self._sitting: _Sitting | None = None
        self._limit = RateLimit(_BURST, _PER_S)

    @property
    def is_taken(self) -> bool:
        """Whether a page is connected."""
        return self._sitting is not None

    async def send(self, said: Said) -> None:
        """Send to the connected page; :meth:`handle` notices a lost connection."""
        if self._sitting is not None:
            await _send(self._sitting.socket, said)

    async def handle(self, request: web.Request) -> web.StreamResponse:
        """Accept a page, and handle its messages until it disconnects."""
        socket = web.WebSocketResponse(
            heartbeat=_HEARTBEAT_S, compress=False, max_msg_size=_MOST_BYTES, timeout=0.5
        )
        await socket.prepare(request)
        key = await _key_of(socket)
        if key is None:
            await socket.close(code=1008)
            return socket
        before = self._sitting
        if before is not None and before.key != key:
            await _send(socket, {'kind': 'taken'})
            await socket.close(code=TAKEN)
            return socket
        mine = self._sitting = _Sitting(key, socket)
        if before is not None:
            await before.socket.close(code=REPLACED)
        try:
            await self._on_change(True)
            async for message in socket:
                said = _read(message.data) if message.type is WSMsgType.TEXT else None
                if said is None or not self._limit.allows(key, time.monotonic()):
                    await socket.close(code=1008)
                    break
                answer = await self._on_message(said)
                if answer is not None:
                    await _send(socket, answer)
        finally:
            if self._sitting is mine:
                self._sitting = None
                await self._on_change(False)
        return socket

    async def close(self) -> None:
        """Close the connection."""
        if self._sitting is not None:
            await self._sitting.socket.close(code=1001)


async def _key_of(socket: web.WebSocketResponse) -> str | None:
    """The key that a page says first; None if it says something else."""
    try:
        message = await asyncio.wait_for(socket.receive(), _HELLO_S)
    except asyncio.TimeoutError:
        return None
    said = _read(message.data) if message.type is WSMsgType.TEXT else None
    key = said.get('hello') if said else None
    return key if isinstance(key, str) and 16 <= len(key) <= 64 else None


async def _send(socket: web.WebSocketResponse, said: Said) -> None:
    try:
        await socket.send_str(json.dumps(said, separators=(',', ':')))
    except (ConnectionError, RuntimeError):
        await socket.close()


def _read(text: str) -> Said | None:
    try:
        said = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return said if isinstance(said, dict) else None
