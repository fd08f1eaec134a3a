"""A study that is served, and pages without a browser."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable, Iterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
from aiohttp import ClientSession, CookieJar, WSMsgType
from studies import Served, served

DEADLINE_S = 20.0
KEYS = ('a' * 16, 'b' * 16)


@pytest.fixture
def study(tmp_path: Path) -> Iterator[Served]:
    """A study whose first participant's session has begun."""
    with served(tmp_path) as made:
        made.desk.begin('P01')
        yield made


def ask(talk: Callable[[ClientSession], Awaitable[Any]]) -> Any:
    """Talk with a server as a client of its own."""

    async def run() -> Any:
        # A number is an address that cookies are kept for, too.
        async with ClientSession(cookie_jar=CookieJar(unsafe=True)) as client:
            return await asyncio.wait_for(talk(client), DEADLINE_S)

    return asyncio.run(run())


class Page:
    """A participant's page."""

    def __init__(self, socket: Any) -> None:
        self.socket = socket
        self.frame: dict[str, Any] = {}

    async def hear(self) -> dict[str, Any]:
        """What the server says next."""
        message = await self.socket.receive()
        assert message.type is WSMsgType.TEXT, message
        said: dict[str, Any] = json.loads(message.data)
        if said['kind'] == 'frame':
            self.frame = said
        return said

    async def act(self, word: str, **fields: Any) -> dict[str, Any]:
        """Do something, and hear what becomes of it."""
        said = {'act': word, 'number': self.frame['acts'], 'step': self.frame['step']}
        await self.socket.send_json({'thinking_s': 1.0, **said, **fields})
        return await self.hear()

    async def go_to(self, step: int) -> None:
        """Go on up to a step, without a trial between."""
        while self.frame['step'] < step:
            await self.act('agree' if self.frame['stage'] == 'consent' else 'next')


@asynccontextmanager
async def page_of(study: Served, client: ClientSession, key: str = KEYS[0]) -> Any:
    """A participant's page that is connected."""
    headers = {'Origin': study.base}
    async with client.ws_connect(f'{study.base}/live', headers=headers) as socket:
        await socket.send_json({'hello': key})
        page = Page(socket)
        await page.hear()
        yield page


async def state_of(study: Served, client: ClientSession) -> Any:
    async with client.get(study.experimenter) as answer:
        assert answer.status == 200
    async with client.get(f'{study.base}/experimenter/state') as answer:
        assert answer.status == 200
        return await answer.json()
