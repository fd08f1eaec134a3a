"""The page in a real browser: a person scopes."""

from __future__ import annotations

import re
import time
from typing import Any

from browser import DEADLINE_MS, NARROW, count_of, drag, needs_chromium, point_of, press, sees
from heard_trials import human_spec
from page_fixture import SCOPED, Opener
from stage import Stage

from blocks_planning.trials.local import run_trial
from blocks_planning.trials.status import TrialStatus

pytestmark = needs_chromium


def test_a_person_scopes_by_dragging(stage: Stage, opened: Opener) -> None:
    """The record is that of the same proposals in a trial of its own."""
    page = opened()
    stage.run(human_spec())
    sees(page, '#participant', 'participant P01')
    confirm = page.get_by_role('button', name='Build this')
    assert confirm.is_disabled()
    drag(page, (0, 0), (3, 3))
    sees(page, '#preview', '12 cells to fill (4 outside, left out).')
    page.get_by_role('button', name='Withdraw').click()
    sees(page, '#answer', 'Withdrawn')
    sees(page, '#preview', 'Nothing is drawn')
    drag(page, (0, 0), (0, 0))
    confirm.click()
    sees(page, '#answer', 'It could not be built')
    drag(page, (3, 3), (0, 0))
    confirm.click()
    sees(page, '#answer', 'It can be built: 12 cells')
    sees(page, '#person-title', 'Your turn')
    drag(page, (0, 2), (3, 5))
    sees(page, '#preview', '4 cells to fill (8 built already, 4 outside, left out).')
    confirm.click()
    sees(page, '#between', 'The tower is complete.')
    sees(page, '#said', re.compile('withdrawn.*could not be built.*built.*built', re.DOTALL))
    (record,) = stage.records
    assert record.status is TrialStatus.SUCCESS
    assert record == run_trial(human_spec(), proposals=record.proposals)
    kinds = [(p.sequence, p.number, p.kind.value) for p in record.proposals]
    assert kinds == [(0, 0, 'withdrawn'), (0, 1, 'build'), (0, 2, 'build'), (3, 0, 'build')]
    assert all(0 < p.thinking_s < 60 for p in record.proposals)


def test_thinking_is_timed_from_when_the_turn_is_shown(stage: Stage, opened: Opener) -> None:
    page = opened()
    page.clock.install()
    stage.run(human_spec())
    sees(page, '#person-title', 'Your turn')
    page.clock.run_for(12_000)
    drag(page, (0, 0), (0, 0))
    page.get_by_role('button', name='Build this').click()
    page.clock.run_for(100)
    sees(page, '#answer', 'could not be built')
    page.clock.run_for(4_000)
    drag(page, (0, 0), (3, 3))
    page.get_by_role('button', name='Build this').click()
    page.clock.run_for(100)
    sees(page, '#answer', 'can be built')
    first, second = (one['thinking_s'] for one in stage.proposed)
    assert 12 <= first < 14
    assert 4 <= second < 6


def test_rows_are_chosen_by_their_number(stage: Stage, opened: Opener) -> None:
    page = opened()
    stage.run(human_spec())
    sees(page, '#person-title', 'Your turn')
    page.mouse.click(*point_of(page, -1, 3))
    sees(page, '#preview', '12 cells to fill (4 outside, left out).')
    page.get_by_role('button', name='Build this').click()
    sees(page, '#answer', 'It can be built: 12 cells')
    assert stage.proposed[0]['region'] == ['....', '....', '####', '####', '####', '####']


def test_what_can_not_be_taken_is_said_before_it_is_sent(stage: Stage, opened: Opener) -> None:
    page = opened()
    stage.run(human_spec())
    sees(page, '#person-title', 'Your turn')
    confirm = page.get_by_role('button', name='Build this')
    drag(page, (1, 0), (2, 1))
    sees(page, '#preview', 'outside the silhouette')
    assert confirm.is_disabled()
    page.keyboard.press('Enter')
    page.mouse.click(*point_of(page, -1, 3))
    confirm.click()
    sees(page, '#answer', 'It can be built')
    drag(page, (0, 0), (3, 2))
    sees(page, '#preview', 'built already')
    assert confirm.is_disabled()
    assert len(stage.proposed) == 1


def test_rectangles_can_be_joined(stage: Stage, opened: Opener) -> None:
    page = opened()
    stage.run(human_spec())
    sees(page, '#person-title', 'Your turn')
    drag(page, (0, 0), (0, 1))
    page.get_by_label('Add to what is drawn').check()
    drag(page, (3, 0), (3, 1))
    sees(page, '#preview', '4 cells to fill.')
    page.get_by_label('Add to what is drawn').uncheck()
    drag(page, (0, 0), (0, 0))
    sees(page, '#preview', '1 cell to fill.')
    page.keyboard.down('Shift')
    drag(page, (3, 0), (3, 0))
    page.keyboard.up('Shift')
    sees(page, '#preview', '2 cells to fill.')


def test_everything_can_be_done_with_the_keyboard(stage: Stage, opened: Opener) -> None:
    page = opened()
    stage.run(human_spec())
    sees(page, '#person-title', 'Your turn')
    page.keyboard.press('Tab')
    page.keyboard.press('Tab')
    assert page.evaluate('document.activeElement.id') == 'board'
    assert page.locator('.cursor').is_visible()
    press(page, 'Space ArrowRight ArrowRight ArrowRight ArrowUp Space')
    sees(page, '#preview', '4 cells to fill (4 outside, left out).')
    press(page, 'Escape')
    sees(page, '#preview', 'Nothing is drawn')
    press(page, 'ArrowUp ArrowUp r Enter')
    sees(page, '#answer', 'It can be built: 12 cells')
    assert stage.proposed[0]['region'] == ['....', '....', '####', '####', '####', '####']
    sees(page, '#person-title', 'Your turn')
    press(page, 'r Tab')
    assert page.evaluate('document.activeElement.id') == 'add'


def test_a_finger_does_as_well(stage: Stage, opened: Opener) -> None:
    page = opened(viewport=NARROW, has_touch=True, is_mobile=True)
    stage.run(human_spec())
    sees(page, '#person-title', 'Your turn')
    page.touchscreen.tap(*point_of(page, 0, 0))
    sees(page, '#preview', '1 cell to fill.')
    touch = page.context.new_cdp_session(page)
    for kind, cell in (('touchStart', (0, 0)), ('touchMove', (3, 3)), ('touchEnd', None)):
        places = [] if cell is None else [dict(zip('xy', point_of(page, *cell), strict=True))]
        touch.send('Input.dispatchTouchEvent', {'type': kind, 'touchPoints': places})
    sees(page, '#preview', '12 cells to fill')


def test_giving_up_is_asked_about(stage: Stage, opened: Opener) -> None:
    page = opened()
    stage.run(human_spec())
    page.get_by_role('button', name='Give up…').click()
    page.get_by_role('dialog').get_by_role('button', name='Go on building').click()
    assert stage.proposed == []
    page.get_by_role('button', name='Give up…').click()
    page.get_by_role('dialog').get_by_role('button', name='Give up').click()
    sees(page, '#between', 'This tower was given up.')
    assert stage.records[0].status is TrialStatus.GAVE_UP


def test_while_it_is_looked_into_nothing_can_be_drawn(stage: Stage, opened: Opener) -> None:
    page = opened()
    stage.held = True
    stage.run(human_spec())
    sees(page, '#person-title', 'Your turn')
    page.mouse.click(*point_of(page, -1, 3))
    page.get_by_role('button', name='Build this').click()
    sees(page, '#person-title', 'Looking for a way to build it…')
    count_of(page, '#board.drawing', 0)
    stage.release()
    sees(page, '#answer', 'It can be built')


def test_what_the_server_refuses_is_said(
    stage: Stage, opened: Opener, troubles: list[str]
) -> None:
    """Somebody else was quicker."""
    page = opened()
    stage.run(human_spec())
    sees(page, '#person-title', 'Your turn')
    drag(page, (0, 0), (0, 0))
    page.route('**/proposal', lambda route: route.continue_(post_data=stale(route)))
    page.get_by_role('button', name='Build this').click()
    sees(page, '#preview', 'Not accepted: the tower has changed meanwhile.')
    assert '409' in troubles.pop()


def stale(route: Any) -> str:
    """What a page would send, about another moment."""
    return str(route.request.post_data).replace('"number":0', '"number":7')


def test_a_page_that_was_killed_is_told_again_what_was_said(stage: Stage, opened: Opener) -> None:
    """Or the next proposal would have a number that the selector does not wait for."""
    page = opened()
    stage.run(human_spec())
    sees(page, '#person-title', 'Your turn')
    drag(page, (0, 0), (3, 3))
    page.get_by_role('button', name='Withdraw').click()
    sees(page, '#said', 'withdrawn')
    drag(page, (0, 0), (0, 0))
    page.get_by_role('button', name='Build this').click()
    sees(page, '#answer', 'could not be built')
    stage.forget()
    deadline = time.monotonic() + DEADLINE_MS / 1000
    while len(stage.proposed) < 4:
        assert time.monotonic() < deadline
        page.wait_for_timeout(5)  # the page does something only while it is waited for
    page.mouse.click(*point_of(page, -1, 3))
    page.get_by_role('button', name='Build this').click()
    sees(page, '#answer', 'It can be built: 12 cells')
    assert stage.session.scene is not None
    numbers = [p.number for p in stage.session.scene.record.proposals]
    assert numbers == [0, 1, 2]


def test_hidden_costs_are_nowhere_on_the_page(stage: Stage, opened: Opener) -> None:
    page = opened()
    frames: list[str] = []

    def keep(frame: str) -> None:
        frames.append(frame)

    def listen(socket: Any) -> None:
        socket.on('framereceived', keep)

    page.on('websocket', listen)
    page.reload()
    stage.run(SCOPED)
    sees(page, '#past', 'chair')
    stage.run(human_spec(costs='hidden'))
    sees(page, '#person-title', 'Your turn')
    page.mouse.click(*point_of(page, -1, 3))
    page.get_by_role('button', name='Build this').click()
    sees(page, '#answer', 'It can be built: 12 cells.')
    assert not page.locator('#costs').is_visible()
    assert not page.locator('#decision').is_visible()
    assert 'state' not in page.locator('main').inner_text()
    said = [frame for frame in frames if '"person":true' in frame]
    assert said
    assert not [frame for frame in said if '"candidates"' in frame or '_cost"' in frame]


def test_a_new_turn_ends_a_replay(stage: Stage, opened: Opener) -> None:
    page = opened()
    stage.run(SCOPED)
    page.get_by_role('button', name='Replay').click()
    sees(page, '#mode', 'replay')
    stage.run(human_spec())
    sees(page, '#mode', 'live')
    sees(page, '#person-title', 'Your turn')
