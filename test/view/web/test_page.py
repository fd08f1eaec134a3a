"""The page in a real browser: what it shows, live and in replay."""

from __future__ import annotations

import re

from browser import count_of, needs_chromium, sees
from builders import CHAIR, NEVER_SOLVED, spec
from page_fixture import SCOPED, Opener
from stage import Stage

from blocks_planning.view.scene import scenes_of
from blocks_planning.view.web.health import NOTHING, health_after

pytestmark = needs_chromium

NASTY = '<img src=x onerror="window.harmed=true"><b>&amp;'


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
