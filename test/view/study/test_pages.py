"""The pages of a study in a real browser: the example study from consent to debrief."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Callable, Iterator
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import pytest
from browser import DEADLINE_MS, NARROW, WIDE, chromium, needs_chromium, point_of
from source_imports import ROOT
from studies import TOKEN, Served, served
from takers import Finger, Keyboard, Participant, sees, stage_of

from blocks_planning.cli import commands
from blocks_planning.fitting.points import points_of
from blocks_planning.study.codebook import TABLES
from blocks_planning.study.desk import Desk
from blocks_planning.study.export import export_study
from blocks_planning.study.spec import read_study
from blocks_planning.trials.reading import read_records
from blocks_planning.view.study.server import StudyServer
from blocks_planning.view.web.guards import Address

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = needs_chromium
Opener = Callable[..., 'Page']
THEMES: tuple[Literal['dark', 'light'], ...] = ('dark', 'light')


@pytest.fixture(scope='module')
def browser() -> Iterator[Browser]:
    with chromium() as made:
        yield made


@pytest.fixture
def opened(browser: Browser) -> Iterator[Opener]:
    """Opens an address in a profile of its own; in the end no page may have complained."""
    contexts, troubles = [], []

    def make(url: str, **options: Any) -> Page:
        context = browser.new_context(**{'viewport': WIDE, **options})
        context.set_default_timeout(DEADLINE_MS)
        contexts.append(context)
        page = context.new_page()
        page.on('pageerror', lambda error: troubles.append(str(error)))
        page.on('console', lambda message: troubles.append(message.text))
        page.goto(url)
        return page

    yield make
    for context in contexts:
        context.close()
    assert [text for text in troubles if not re.search('ERR_CONN|closed before', text)] == []


def violations(page: Page) -> list[str]:
    """What axe-core finds on a page."""
    from axe_playwright_python.sync_playwright import Axe

    found = Axe().run(page).response['violations']
    return [f'{one["id"]}: {node["html"]}' for one in found for node in one['nodes']]


def looked_at(page: Page) -> Iterator[list[str]]:
    """What is wrong with a page in both widths and both themes; then it is as it was."""
    before = page.viewport_size
    assert before is not None
    for theme, size in product(THEMES, (NARROW, WIDE)):
        page.emulate_media(color_scheme=theme)
        page.set_viewport_size({'width': size['width'], 'height': size['height']})
        found = violations(page)
        width = page.evaluate('document.documentElement.scrollWidth')
        yield found if width <= size['width'] else [*found, f'{theme}: {width} px wide']
    page.set_viewport_size(before)


class Lab:
    """The example study, as the command serves it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        study = read_study(ROOT / 'config' / 'studies' / 'example.yaml')
        self.desk = Desk(study, folder)
        self.server = StudyServer(Address(), self.desk, TOKEN)
        self.server.start()


@pytest.fixture
def lab(tmp_path: Path) -> Iterator[Lab]:
    made = Lab(tmp_path / 'study')
    yield made
    made.server.stop()


def test_three_participants_and_what_they_leave(lab: Lab, opened: Opener, tmp_path: Path) -> None:
    """One with a mouse, one with a finger, one with the keyboard, who leaves and comes back."""
    experimenter = opened(lab.server.experimenter.url)
    url = lab.server.address.url
    looks: list[tuple[type[Participant], dict[str, Any]]] = [
        (Participant, {}),
        (
            Finger,
            {'viewport': NARROW, 'has_touch': True, 'is_mobile': True, 'color_scheme': 'dark'},
        ),
        (Keyboard, {'color_scheme': 'dark'}),
    ]
    for number, (kind, options) in enumerate(looks):
        experimenter.get_by_role('button', name='Begin').click()
        someone = kind(opened(url, **options))
        stages = walk(someone, opened, url, options, leaves=kind is Keyboard, checks=number == 0)
        counts = [stages.count(stage) for stage in ('consent', 'scoping', 'marking', 'building')]
        assert counts == [1, 3, 3, 3]
        someone.page.context.close()
    assert list(looked_at(experimenter)) == [[]] * 4
    lab.server.stop()
    compare(lab.folder, tmp_path / 'tables')


def walk(
    someone: Participant, opened: Opener, url: str, options: Any, leaves: bool, checks: bool
) -> list[str]:
    """Go through the study; tell what the pages were."""
    checked: set[str] = set()
    while not someone.seen or someone.seen[-1] != 'over':
        stage = stage_of(someone.page)
        if checks and stage not in checked:
            checked.add(stage)
            for problems in looked_at(someone.page):
                assert problems == [], stage
        if leaves and stage == 'building':
            leaves = False
            label = someone.page.locator('#tower-name').text_content()
            someone.page.context.close()
            someone.page = opened(url, **options)
            assert stage_of(someone.page) == 'building'
            assert someone.page.locator('#tower-name').text_content() == label
        someone.go_on()
    return someone.seen


def compare(folder: Path, out: Path) -> None:
    """Tables, codebook and records agree, and are what fits are made of."""
    exported = export_study(folder, out)
    tables = {}
    for name in TABLES:
        with (out / f'{name}.csv').open(newline='') as file:
            tables[name] = list(csv.DictReader(file))
        assert len(tables[name]) == exported.files[f'{name}.csv'] > 0
    people = [(row['participant'], row['status']) for row in tables['participants']]
    assert people == [(code, 'finished') for code in ('P01', 'P02', 'P03')]
    assert [row['visits'] for row in tables['participants']] == ['1', '1', '2']
    paths = [*out.glob('records/*'), *out.glob('practice/*')]
    run('verify', '--rerun', *map(str, paths))
    records = {path: read_records(path) for path in paths}
    every = [record for path in paths for record in records[path]]
    assert len(every) == len(tables['trials']) == 18
    assert sum(record.blocks for record in every) == len(tables['placements'])
    assert sum(len(record.proposals) for record in every) == len(tables['proposals'])
    assert len(points_of(every)) == sum(row['kind'] == 'build' for row in tables['proposals'])
    scoped = out / 'records' / 'scoping.jsonl'
    run(
        'fit',
        str(scoped),
        '--model',
        'rows',
        '--model',
        'random',
        '--no-intervals',
        '--out',
        str(out / 'fitted'),
    )
    with (out / 'fitted' / 'fits.csv').open(newline='') as file:
        fits = list(csv.DictReader(file))
    chosen = Counter(point.session for point in points_of(records[scoped]))
    assert {row['session']: int(row['choices']) for row in fits} == {
        **{code: chosen[code] for code in ('P01', 'P02', 'P03')},
        'all': chosen.total(),
    }
    assert min(chosen.values()) > 0


def run(*words: str) -> None:
    """Run a command; it must not complain."""
    assert not commands.main(list(words), standalone_mode=False)


# A smaller study


@pytest.fixture
def small(tmp_path: Path) -> Iterator[Served]:
    with served(tmp_path) as made:
        made.desk.begin('P01')
        yield made


def test_texts_are_shown_as_text(small: Served, opened: Opener) -> None:
    page = opened(small.participant)
    sees(page, '#text', '<b onclick="harmed=1">Everything</b> is kept.')
    assert page.locator('#text em').text_content() == 'kept'
    assert page.locator('#text b').count() == 0


def test_a_second_window_is_refused_and_can_be_used_later(small: Served, opened: Opener) -> None:
    first, second = opened(small.participant), opened(small.participant)
    Participant(first).leave_step()
    sees(second, '#text', 'open in another window')
    assert violations(second) == []
    first.context.close()
    second.get_by_role('button', name='Try again').click()
    sees(second, '#text', 'Look at the towers.')


def test_a_reload_goes_on_where_it_was(small: Served, opened: Opener) -> None:
    page = opened(small.participant)
    someone = Participant(page)
    while stage_of(page) != 'scoping':
        someone.go_on()
    page.mouse.click(*point_of(page, -1, 1))
    someone.press('Build this')
    sees(page, '#answer', 'It is built.')
    page.reload()
    assert stage_of(page) == 'scoping'
    assert page.locator('.block').count() == 2


def test_what_is_drawn_stays_when_the_pointer_leaves(small: Served, opened: Opener) -> None:
    page = opened(small.participant)
    someone = Participant(page)
    while stage_of(page) != 'scoping':
        someone.go_on()
    page.mouse.click(*point_of(page, -1, 1))
    drawn = page.locator('.draw-edge').get_attribute('d')
    page.get_by_role('button', name='Build this').hover()
    assert page.locator('.draw-edge').get_attribute('d') == drawn != ''


def test_a_lost_server_is_told_and_found_again(tmp_path: Path, opened: Opener) -> None:
    first = Served(tmp_path)
    first.desk.begin('P01')
    page = opened(first.participant)
    Participant(page).leave_step()
    first.crash()
    sees(page, '#banner', 'The connection is lost. Nothing that you did is lost')
    page.locator('#go-on').click()  # what is done meanwhile is sent later
    with served(tmp_path, port=first.server.address.port):
        sees(page, '#text', 'Draw.')


def test_what_cannot_be_had_is_told(small: Served, opened: Opener) -> None:
    page = opened(small.participant)
    someone = Participant(page)
    while stage_of(page) != 'building':
        if stage_of(page) == 'scoping':
            someone.give_up()
            someone.leave_step()
        else:
            someone.go_on()
    page.locator('.piece').nth(3).click()
    page.mouse.move(*point_of(page, 1, 1))
    sees(page, '#preview', 'it would stick out of the silhouette')
    page.mouse.click(*point_of(page, 1, 1))
    sees(page, '#answer', 'This was not taken: the block would stick out of the silhouette.')
    assert violations(page) == []
    page.get_by_role('button', name='Stop taking part…').click()
    assert violations(page) == []
    page.get_by_role('dialog').get_by_role('button', name='Yes').click()
    sees(page, '#text', 'Thank you.')
