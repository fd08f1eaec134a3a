"""The server of the page, and a client of it."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable
from concurrent.futures import Future
from functools import reduce
from typing import Any

from aiohttp import ClientSession, WSMsgType
from heard_trials import Heard

from blocks_planning.subgoals.drawn import Refused
from blocks_planning.view.web.frame import Seen
from blocks_planning.view.web.guards import Address
from blocks_planning.view.web.live import Mailbox
from blocks_planning.view.web.server import PageServer
from blocks_planning.view.web.session import session_after

TOKEN = 'a-token_of-24-characters'
DEADLINE_S = 20.0


class Served:
    """A server that runs, and what was proposed to it."""

    def __init__(self, address: Address) -> None:
        self.mailbox = Mailbox()
        self.proposed: list[Any] = []
        self.answer: Refused | Exception | None = None
        self.server = PageServer(address, self.mailbox, self._propose)
        self.server.start()
        self.base = f'http://127.0.0.1:{self.server.address.port}'
        self.from_page = {'Origin': self.base}

    def _propose(self, data: Any) -> Future[Refused | None]:
        self.proposed.append(data)
        answer: Future[Refused | None] = Future()
        if isinstance(self.answer, Exception):
            answer.set_exception(self.answer)
        else:
            answer.set_result(self.answer)
        return answer

    def show(self, trial: Heard, count: int | None = None) -> None:
        """Put what was heard so far into the mailbox."""
        session = reduce(session_after, trial.messages[:count], self.mailbox.seen.session)
        self.mailbox.put(Seen(session))


def ask(talk: Callable[[ClientSession], Awaitable[Any]]) -> Any:
    """Talk with a server as a client of its own."""

    async def run() -> Any:
        async with ClientSession() as client:
            return await asyncio.wait_for(talk(client), DEADLINE_S)

    return asyncio.run(run())


def status_of(served: Served, method: str, path: str, **options: Any) -> int:
    """What a request is answered with."""

    async def talk(client: ClientSession) -> int:
        options.setdefault('allow_redirects', False)
        async with client.request(method, served.base + path, **options) as answer:
            await answer.read()
            return answer.status

    status: int = ask(talk)
    return status


def post(served: Served, data: Any = None, **headers: str) -> tuple[int, Any]:
    """Propose something, as the page does."""

    async def talk(client: ClientSession) -> tuple[int, Any]:
        sent = served.from_page | headers
        async with client.post(
            f'{served.base}/proposal', json={} if data is None else data, headers=sent
        ) as answer:
            return answer.status, await answer.json()

    said: tuple[int, Any] = ask(talk)
    return said


async def next_frame(live: Any) -> Any:
    """The next frame of a socket."""
    message = await live.receive()
    assert message.type is WSMsgType.TEXT, message
    return json.loads(message.data)
