"""The page in front of the whole graph: a person scopes two towers in a browser."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import urllib.request
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from browser import DEADLINE_MS, WIDE, chromium, drag, needs_chromium
from graphs import (
    bring_up,
    local_lines,
    node_processes,
    record_lines,
    run_graph,
    wait_until,
    write_script,
)

from blocks_planning.trials.local import run_trial
from blocks_planning.trials.reading import read_records
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions

if TYPE_CHECKING:
    from playwright.sync_api import Page

TOWERS = """\
tower gate
####
####
#..#
#..#

tower steps
##..
##..
####
####
"""


def address_of(process: subprocess.Popen[str]) -> str:
    """Where the page is, as the bring-up says it."""
    assert process.stderr is not None
    for line in process.stderr:
        if line.startswith('The page: '):
            return line.split()[-1]
    raise AssertionError('no address was said')


def is_served(url: str) -> bool:
    """Whether somebody answers there."""
    try:
        with urllib.request.urlopen(url, timeout=5) as answer:
            return bool(answer.read())
    except OSError:
        return False


def build(page: Page, tower: str, *areas: tuple[tuple[int, int], tuple[int, int]]) -> None:
    """Scope a tower area by area."""
    from playwright.sync_api import expect

    expect(page.locator('#tower-name')).to_have_text(tower)
    for number, (start, end) in enumerate(areas, start=1):
        expect(page.locator('#board')).to_have_class('drawing')
        drag(page, start, end)
        page.get_by_role('button', name='Build this').click()
        if number < len(areas):  # after the last one another tower may be there
            expect(page.locator('#said li').nth(number - 1)).to_contain_text(': built')


@pytest.mark.long
@needs_chromium
def test_a_person_scopes_two_towers_in_a_browser(tmp_path: Path) -> None:
    from playwright.sync_api import expect

    towers = tmp_path / 'towers.txt'
    towers.write_text(TOWERS, encoding='utf-8')
    person = {'name': 'human', 'participant': 'P01', 'costs': 'shown'}
    script = write_script(tmp_path, stimuli=[str(towers)], strategies=[person])
    out = tmp_path / 'out'
    with bring_up(script, '--out', out, '--view', '--pace', '0.05') as process:
        url = address_of(process)
        wait_until(process, lambda: is_served(url))
        with chromium() as browser:
            page = browser.new_page(viewport=WIDE)  # type: ignore[arg-type]
            page.set_default_timeout(DEADLINE_MS)
            page.goto(url)
            build(page, 'towers.txt/gate', ((0, 0), (3, 1)), ((0, 2), (3, 3)))
            build(page, 'towers.txt/steps', ((0, 0), (3, 1)), ((0, 0), (1, 3)))
            expect(page.locator('#banner')).to_contain_text('The session is over')
            process.communicate(timeout=60)
            page.get_by_role('button', name='Replay trial 1, towers.txt/gate').click()
            expect(page.locator('#mode')).to_contain_text('replay of trial 1')
    assert process.returncode == 0
    records = read_records(out / 'trials.jsonl')
    assert [record.spec.stimulus for record in records] == [f'{towers}/gate', f'{towers}/steps']
    for record in records:
        assert record.status is TrialStatus.SUCCESS
        assert record.subgoals == 2
        assert list(contradictions(record)) == []
        assert len(record.proposals) == 2
        assert all(0 < proposal.thinking_s < 60 for proposal in record.proposals)
        assert run_trial(record.spec, proposals=record.proposals) == record


def test_page_shows_a_script_and_ends_with_it(tmp_path: Path) -> None:
    """The records are those of a run that nobody looks at."""
    script, out = write_script(tmp_path, seeds=3), tmp_path / 'out'
    done = run_graph(script, '--out', out, '--view')
    assert done.returncode == 0, done.stderr
    assert record_lines(out) == local_lines(script)
    assert 'Traceback' not in done.stderr
    urls = re.findall(r'http://\S+', done.stderr)
    assert len(urls) == 1
    assert re.fullmatch(r'http://127\.0\.0\.1:\d+/', urls[0])
    assert not is_served(urls[0])


@pytest.mark.long
def test_page_that_dies_is_served_again_at_the_same_address(tmp_path: Path) -> None:
    script = write_script(tmp_path, seeds=60)
    out = tmp_path / 'out'
    with bring_up(script, '--out', out, '--view', '--pace', '0.15') as process:
        url = address_of(process)
        wait_until(process, lambda: is_served(url) and len(record_lines(out)) >= 1)
        before = node_processes(process.pid)['trial_view']
        os.kill(before, signal.SIGKILL)
        wait_until(process, lambda: is_served(url))
        assert node_processes(process.pid)['trial_view'] != before
        recorded = len(record_lines(out))
        wait_until(process, lambda: len(record_lines(out)) > recorded + 1)
        process.send_signal(signal.SIGINT)  # how long a page takes to come back is not known
        process.communicate(timeout=90)
    lines = record_lines(out)
    assert lines == local_lines(script)[: len(lines)]


@pytest.mark.parametrize(
    ('arguments', 'said'),
    [
        (('--view-host', 'nowhere.invalid'), 'cannot be served at nowhere.invalid:0'),
        (('--view-host', '192.0.2.1'), 'cannot be served at 192.0.2.1:0'),
    ],
)
def test_impossible_address_is_refused_before_anything_starts(
    arguments: tuple[str, ...], said: str, tmp_path: Path
) -> None:
    script = write_script(tmp_path)
    done = run_graph(script, '--out', tmp_path / 'out', '--view', *arguments)
    assert done.returncode == 2
    assert said in done.stderr
    assert 'Traceback' not in done.stderr
