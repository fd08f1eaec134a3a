"""The server of a study: a page for the participant, and one for the experimenter.

The participant's page has one socket and nothing else: it sends acts and notes, and gets frames.
The experimenter's page needs a token of its own, whatever the address. Sessions are worked on in
another thread, one thing at a time, because a search or a disk may take long.
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

from blocks_planning.errors import ConfigurationError, InvalidInput, RecordError
from blocks_planning.extras import extra
from blocks_planning.study.desk import Desk
from blocks_planning.subgoals.drawn import Refused
from blocks_planning.view.study.frame import frame_json
from blocks_planning.view.study.overview import overview_json
from blocks_planning.view.study.seat import Said, Seat
from blocks_planning.view.web import server as live_page
from blocks_planning.view.web.guards import Address, new_token
from blocks_planning.view.web.serving import SOCKET, Handler, Server, refusal, sender

with extra('page'):
    from aiohttp import web

T = TypeVar('T')
EXPERIMENTER = 'experimenter'
_TICK_S = 0.25
_STATIC = Path(__file__).with_name('static')
_SHARED = ('board.js', 'cells.js', 'dom.js', 'drawing.js', 'icon.svg', 'style.css')
"""Files of the live page that these pages use too."""
_FILES = (
    *(path for path in _STATIC.iterdir() if path.suffix != '.html'),
    *(live_page.STATIC / name for name in _SHARED),
)
_NOT_KEPT = 'This could not be saved, so it has not happened. Please tell the experimenter.'


class StudyServer(Server):
    """Serves the desk of a study.

    Attributes:
        experimenter: address of the experimenter's page.
    """

    public = frozenset(f'/{path.name}' for path in _FILES)

    def __init__(self, address: Address, desk: Desk, token: str = '') -> None:
        """Prepare the server.

        Args:
            address: of the participant's page.
            desk: of the study.
            token: of the experimenter's page; '': a new one.
        """
        self.experimenter = Address(address.host, address.port, token or new_token(), EXPERIMENTER)
        super().__init__(address)
        self._desk = desk
        self._seat = Seat(self._on_change, self._on_message)
        self._lock = asyncio.Lock()
        self._trouble = ''

    def add_routes(self, router: web.UrlDispatcher) -> None:
        """See :class:`Server`."""
        for path in _FILES:
            router.add_get(f'/{path.name}', sender(path))
        router.add_get('/', sender(_STATIC / 'participant.html'))
        router.add_get(f'/{EXPERIMENTER}', sender(_STATIC / 'experimenter.html'))
        router.add_get(SOCKET, self._seat.handle)
        router.add_get(f'/{EXPERIMENTER}/state', self._state)
        for name, do in (
            ('begin', self._desk.begin),
            ('reopen', self._desk.reopen),
            ('close', lambda _: self._desk.close()),
        ):
            router.add_post(f'/{EXPERIMENTER}/{name}', self._command(do))

    def door(self, path: str) -> Address:
        """See :class:`Server`."""
        is_hers = path == f'/{EXPERIMENTER}' or path.startswith(f'/{EXPERIMENTER}/')
        return self.experimenter if is_hers else self.address

    def take_port(self, port: int) -> None:
        """See :class:`Server`."""
        super().take_port(port)
        self.experimenter = replace(self.experimenter, port=port)

    async def work(self) -> None:
        """End trials whose time is over."""
        while True:
            await asyncio.sleep(_TICK_S)
            session = self._desk.session
            if session is not None and session.left_s == 0.0:
                try:
                    await self._do(session.tick)
                except RecordError:
                    continue
                await self._show()

    async def say_farewell(self) -> None:
        """See :class:`Server`."""
        with suppress(RecordError):
            await self._do(self._desk.release)
        await self._seat.close()

    async def _do(self, function: Callable[[], T]) -> T:
        """Do something with the desk or its session, alone; remember what went wrong."""
        async with self._lock:
            try:
                done = await asyncio.to_thread(function)
            except RecordError as error:
                self._trouble = str(error)
                raise
            return done

    async def _show(self) -> None:
        await self._seat.send(frame_json(self._desk.study.title, self._desk.session))

    async def _on_change(self, is_there: bool) -> None:
        """The participant's page is connected, or is not any more."""
        session = self._desk.session
        if session is not None and session.step is not None:
            with suppress(RecordError):  # the experimenter's page says so
                await self._do(session.arrive if is_there else session.leave)
        await self._show()

    async def _on_message(self, said: Said) -> Said | None:
        """What the participant's page says: a note, or an act."""
        session = self._desk.session
        if session is None:
            return {'kind': 'refused', 'code': 'over', 'reason': 'the session is over'}
        try:
            if 'note' in said:
                await self._do(lambda: session.note(said))
                return None
            refused = await self._do(lambda: session.act(said))
        except RecordError:
            refused = Refused('disk', _NOT_KEPT)
        except InvalidInput as error:
            refused = Refused('malformed', str(error))
        if refused is None:
            return frame_json(self._desk.study.title, session)
        return {'kind': 'refused', **refused._asdict(), 'act': said.get('number')}

    async def _state(self, _: web.Request) -> web.StreamResponse:
        """How the study stands."""
        async with self._lock:
            state = overview_json(self._desk, self._seat.is_taken, self._trouble)
        return web.json_response(state)

    def _command(self, do: Callable[[str], None]) -> Handler:
        """A handler of something that the experimenter does with a participant's code."""

        async def handle(request: web.Request) -> web.StreamResponse:
            code = await _code_of(request)
            if code is None:
                return refusal(400, 'malformed', 'expected {"code": "..."} as JSON')
            try:
                await self._do(lambda: do(code))
            except (ConfigurationError, RecordError) as error:
                return refusal(409, 'refused', str(error))
            self._trouble = ''
            if self._seat.is_taken:
                await self._on_change(True)
            return await self._state(request)

        return handle


async def _code_of(request: web.Request) -> str | None:
    try:
        data: Any = json.loads(await request.text())
    except (ValueError, RecursionError):
        return None
    code = data.get('code') if isinstance(data, dict) else None
    return code if isinstance(code, str) and request.content_type == 'application/json' else None
