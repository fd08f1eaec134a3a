"""The page in a real browser, in front of a graph in this process."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import pytest
from browser import DEADLINE_MS, NARROW, WIDE, chromium, drag, needs_chromium, point_of
from builders import CHAIR, NEVER_SOLVED, spec
from stage import Stage

from blocks_planning.trials.local import run_trial
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view.scene import scenes_of
from blocks_planning.view.web.health import NOTHING, health_after

from .conftest import human_spec

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = needs_chromium
SCOPED = spec(CHAIR, lam=0.2, depth=2, stimulus='chair')
NASTY = '<img src=x onerror="window.harmed=true"><b>&amp;'
Opener = Callable[..., 'Page']


@pytest.fixture(scope='module')
def browser() -> Iterator[Browser]:
    """One browser for all; every test has a profile of its own."""
    with chromium() as made:
        yield made


@pytest.fixture
def stage() -> Iterator[Stage]:
    """A graph in this process, and its page."""
    made = Stage((SCOPED, spec(CHAIR, seed=1, stimulus='next')))
    yield made
    made.server.stop()


@pytest.fixture
def troubles() -> list[str]:
    """What went wrong on a page: in the end there must be nothing left here."""
    return []


@pytest.fixture
def opened(browser: Browser, stage: Stage, troubles: list[str]) -> Iterator[Opener]:
    """Opens the page."""
    from playwright.sync_api import expect

    contexts = []

    def make(**options: Any) -> Page:
        context = browser.new_context(**{'viewport': WIDE, **options})
        context.set_default_timeout(DEADLINE_MS)
        contexts.append(context)
        page = context.new_page()
        page.on('pageerror', lambda error: troubles.append(str(error)))
        page.on(
            'console',
            lambda message: (
                troubles.append(message.text)
                if message.type in ('error', 'warning')
                and not re.search('ERR_CONN|closed before', message.text)
                else None
            ),
        )
        page.goto(stage.url)
        expect(page.locator('#connection')).to_have_attribute('data-state', 'live')
        return page

    yield make
    for context in contexts:
        context.close()
    assert troubles == []


def sees(page: Page, selector: str, text: str | re.Pattern[str]) -> None:
    """Wait until a part of the page holds a text."""
    from playwright.sync_api import expect

    expect(page.locator(selector)).to_be_visible()
    expect(page.locator(selector)).to_contain_text(text)


def count_of(page: Page, selector: str, count: int) -> None:
    """Wait until there are so many of something on the page."""
    from playwright.sync_api import expect

    expect(page.locator(selector)).to_have_count(count)


# What is shown


def test_a_trial_is_shown_live(stage: Stage, opened: Opener) -> None:
    page = opened()
    sees(page, '#progress-text', 'Waiting for the first trial')
    stage.run(SCOPED)
    record = stage.records[0]
    sees(page, '#tower-name', 'chair')
    sees(page, '#status', f'success · {record.blocks} blocks')
    count_of(page, '.block', record.blocks)
    decision = record.decisions[-1].decision
    count_of(page, '#candidates tbody tr', len(decision.candidates))
    count_of(page, '#candidates tr[data-chosen]', 1)
    sees(page, '#cost-action', f'{record.action_planning_cost:,}')
    sees(page, '#cost-subgoal', f'{record.subgoal_planning_cost:,}')
    count_of(page, '#curve .mark.action', len(record.decisions))
    sees(page, '#progress-text', 'Trial 1 of 2: chair')
    sees(page, '#coming', 'Next: next')
    sees(page, '#past tbody tr', re.compile(rf'chair.*✓ success{record.blocks}', re.DOTALL))


def test_blocks_have_the_colours_of_their_subgoals(stage: Stage, opened: Opener) -> None:
    from blocks_planning.view.palette import fills_of
    from blocks_planning.view.scene import last_scene

    page = opened()
    stage.run(SCOPED)
    scene = last_scene(stage.records[0])
    count_of(page, '.block', len(scene.blocks))
    fills = page.locator('.block rect').evaluate_all('all => all.map(e => e.getAttribute("fill"))')
    assert fills == fills_of(scene.blocks)
    labels = page.locator('.block text').all_text_contents()
    assert labels == [str(block.subgoal + 1) for block in scene.blocks]


def test_what_fails_is_told(stage: Stage, opened: Opener) -> None:
    page = opened()
    stage.run(spec(NEVER_SOLVED, stimulus='never'))
    sees(page, '#status', 'gave up')
    sees(page, '#decision-note', 'None could be built')
    sees(page, '#past', '✗ gave up')


def test_nodes_are_shown_with_what_they_say(stage: Stage, opened: Opener) -> None:
    page = opened()
    health = health_after(NOTHING, 'world', 0, 'building', [('load', '0.25')], 1e9)
    stage.show_health(health_after(health, 'searcher', 1, 'slow', [], 1e9))
    sees(page, '#health li[data-level=ok]', 'world')
    sees(page, '#health li[data-level=warning]', 'slow')
    page.get_by_text('building', exact=True).click()
    sees(page, '#health dl >> nth=1', 'load')
    stage.show_health(health_after(NOTHING, 'world', 2, 'no journal', [('load', '1')], 1e9))
    sees(page, '#health li[data-level=error]', 'no journal')
    count_of(page, '#health li', 1)
    assert page.locator('#health dl').is_visible()  # what was open stays open


def test_names_are_shown_as_text_everywhere(stage: Stage, opened: Opener) -> None:
    page = opened()
    nasty = spec(CHAIR, stimulus=NASTY)
    stage.run(nasty)
    stage.show_health(health_after(NOTHING, NASTY, 1, NASTY, [(NASTY, NASTY)], 1e9))
    for place in ('#tower-name', '#progress-text', '#past tbody tr', '#health'):
        sees(page, place, NASTY)
    page.get_by_role('button', name='Replay').click()
    sees(page, '#mode', 'replay')
    assert page.locator('main img, main b').count() == 0
    assert page.evaluate('window.harmed') is None


def test_policy_lets_no_foreign_script_run(
    stage: Stage, opened: Opener, troubles: list[str]
) -> None:
    """Even if something got into the page as markup."""
    page = opened()
    page.evaluate("document.body.insertAdjacentHTML('beforeend', '<i onclick=harmed=1>x</i>')")
    page.locator('body > i').click()
    assert page.evaluate('window.harmed') is None
    assert len(troubles) == 1
    assert 'Content Security Policy' in troubles.pop()


# Replay


def test_a_trial_that_ran_is_replayed_step_by_step(stage: Stage, opened: Opener) -> None:
    page = opened()
    stage.run(SCOPED)
    stage.run(spec(CHAIR, seed=1, stimulus='next'))
    scenes = list(scenes_of(stage.records[0]))
    page.get_by_role('button', name='Replay trial 1, chair').click()
    sees(page, '#mode', 'replay of trial 1')
    sees(page, '#tower-name', 'chair')
    page.keyboard.press('Home')
    for number, scene in enumerate(scenes):
        sees(page, '#step-text', f'step {number} of {len(scenes) - 1}')
        count_of(page, '.block', len(scene.placements))
        count_of(page, 'path.region', int(scene.region != 0))
        sees(page, '#cost-subgoal', f'{scene.record.subgoal_planning_cost:,} ')
        page.keyboard.press('ArrowRight')
    sees(page, '#status', 'success')
    page.keyboard.press('ArrowLeft')
    sees(page, '#step-text', f'step {len(scenes) - 2} of')
    page.keyboard.press('Escape')
    sees(page, '#mode', 'live')
    sees(page, '#tower-name', 'next')


def test_replay_plays_by_itself_until_the_end(stage: Stage, opened: Opener) -> None:
    page = opened()
    page.clock.install()
    stage.run(SCOPED)
    steps = len(list(scenes_of(stage.records[0]))) - 1
    page.get_by_role('button', name='Replay').click()
    sees(page, '#play-text', 'Pause')
    page.clock.run_for(700)
    sees(page, '#step-text', 'step 1 of')
    page.keyboard.press('Space')
    sees(page, '#play-text', 'Play')
    page.clock.run_for(7000)
    sees(page, '#step-text', 'step 1 of')
    page.locator('#play').click()
    page.clock.run_for(700 * (steps + 1))
    sees(page, '#step-text', f'step {steps} of {steps}')
    sees(page, '#play-text', 'Play')


def test_scrubber_goes_where_it_is_moved(stage: Stage, opened: Opener) -> None:
    page = opened()
    stage.run(SCOPED)
    page.get_by_role('button', name='Replay').click()
    page.get_by_role('slider', name='Step').fill('3')
    sees(page, '#step-text', 'step 3 of')
    page.get_by_role('slider', name='Step').press('ArrowRight')
    sees(page, '#step-text', 'step 4 of')
    page.get_by_role('button', name='Back to live').click()
    sees(page, '#mode', 'live')


# The link


def test_when_the_session_is_over_what_ran_can_still_be_replayed(
    stage: Stage, opened: Opener
) -> None:
    page = opened()
    stage.run(SCOPED)
    stage.server.stop()
    sees(page, '#banner', 'The session is over')
    count_of(page, '.block', stage.records[0].blocks)
    page.get_by_role('button', name='Replay').click()
    sees(page, '#mode', 'replay')
    page.keyboard.press('Home')
    sees(page, '#step-text', 'step 0 of')
    count_of(page, '.block', 0)


def test_it_connects_again_by_itself(stage: Stage, opened: Opener) -> None:
    page = opened()
    stage.run(SCOPED)
    sees(page, '#past', 'chair')
    stage.crash()
    sees(page, '#connection', 'connection lost')
    second = Stage(port=stage.server.address.port)
    try:
        sees(page, '#connection-text', re.compile('^live$'))
        second.run(spec(CHAIR, seed=1, stimulus='of the second'))
        sees(page, '#tower-name', 'of the second')
        count_of(page, '#past tbody tr', 1)
        sees(page, '#past', 'of the second')
    finally:
        second.server.stop()


# The person


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


def press(page: Page, keys: str) -> None:
    """Press keys one after the other."""
    for key in keys.split():
        page.keyboard.press(key)


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


# For everybody


def looks(stage: Stage, page: Page) -> Iterator[str]:
    """Bring the page into one of its states after the other."""
    yield 'empty'
    stage.run(SCOPED)
    stage.show_health(health_after(NOTHING, 'world', 1, 'slow', [('load', '1')], 1e9))
    sees(page, '#past', 'chair')
    yield 'live'
    page.get_by_role('button', name='Replay').click()
    sees(page, '#mode', 'replay')
    yield 'replay'
    stage.run(human_spec())
    sees(page, '#person-title', 'Your turn')
    drag(page, (0, 0), (3, 3))
    sees(page, '#preview', 'cells to fill')
    yield 'person'


CONTRASTS = """() => {
    const canvas = document.createElement('canvas').getContext('2d', {willReadFrequently: true});
    const rgba = (colour) => {
        canvas.clearRect(0, 0, 1, 1);
        canvas.fillStyle = colour;
        canvas.fillRect(0, 0, 1, 1);
        return canvas.getImageData(0, 0, 1, 1).data;
    };
    const luminance = (colour) => {
        const [r, g, b] = [...rgba(colour)].slice(0, 3).map((level) => level / 255)
            .map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const behind = (element) => {
        for (let at = element; at; at = at.parentElement) {
            const colour = getComputedStyle(at).backgroundColor;
            if (rgba(colour)[3] === 255) return colour;
        }
        return 'white';
    };
    const found = [];
    const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (texts.nextNode()) {
        const element = texts.currentNode.parentElement;
        const text = texts.currentNode.textContent.trim();
        if (!text || !element.checkVisibility() || element.closest('svg, :disabled')) continue;
        if (element.closest('.visually-hidden, .skip')) continue;
        const [a, b] = [getComputedStyle(element).color, behind(element)].map(luminance);
        const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
        found.push([ratio, text]);
    }
    return found;
}"""


@pytest.mark.parametrize('scheme', ['light', 'dark'])
def test_texts_stand_out(scheme: str, stage: Stage, opened: Opener) -> None:
    """By 4.5 to 1, as WCAG 2 asks for."""
    page = opened(color_scheme=scheme)
    for look in looks(stage, page):
        contrasts = page.evaluate(CONTRASTS)
        assert len(contrasts) > 10
        assert [one for one in contrasts if one[0] < 4.5] == [], look
    dark = page.evaluate("getComputedStyle(document.body).backgroundColor === 'rgb(16, 19, 22)'")
    assert dark == (scheme == 'dark')


@pytest.mark.parametrize('width', [1280, 400, 320])
def test_nothing_sticks_out(width: int, stage: Stage, opened: Opener) -> None:
    page = opened(viewport={'width': width, 'height': 800})
    for look in looks(stage, page):
        assert page.evaluate('document.documentElement.scrollWidth') <= width, look
        outside = page.evaluate("""() => [...document.querySelectorAll('main *')]
            .filter((e) => e.checkVisibility() && !e.closest('.visually-hidden, svg'))
            .filter((e) => e.getBoundingClientRect().right > innerWidth)
            .map((e) => e.id || e.tagName)""")
        assert outside == [], look


def test_every_control_has_a_name_and_shows_its_focus(stage: Stage, opened: Opener) -> None:
    page = opened()
    least = {'empty': 0, 'live': 2, 'replay': 8, 'person': 6}
    for look in looks(stage, page):
        seen: list[Any] = []
        page.locator('.skip').focus()
        page.keyboard.press('Tab')
        while (here := focused(page)) is not None and here not in seen:
            seen.append(here)
            page.keyboard.press('Tab')
        assert [one for one in seen if not one[1] or not one[2]] == [], look
        assert len(seen) >= least[look], look


def focused(page: Page) -> Any:
    """What has the focus: what it is, its name, and whether its focus is seen; or nothing."""
    return page.evaluate("""() => {
        const e = document.activeElement;
        const label = e.getAttribute('aria-label') || e.labels?.[0]?.textContent.trim();
        const place = [...document.querySelectorAll('*')].indexOf(e);
        return e === document.body ? null : [
            place, label || e.textContent.trim(), getComputedStyle(e).outlineStyle !== 'none',
        ];
    }""")


def test_nothing_moves_for_who_does_not_want_it(stage: Stage, opened: Opener) -> None:
    for motion, moves in (('no-preference', True), ('reduce', False)):
        page = opened(reduced_motion=motion)
        stage.run(SCOPED)
        page.get_by_role('button', name='Replay').first.click()
        sees(page, '#mode', 'replay')
        press(page, 'Home ArrowRight ArrowRight')
        count_of(page, '.block', 1)
        name = page.locator('.block').evaluate('e => getComputedStyle(e).animationName')
        assert name == ('drop' if moves else 'none')
