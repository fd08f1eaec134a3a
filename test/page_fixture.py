"""The page in a real browser, in front of a graph in this process."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import pytest
from browser import DEADLINE_MS, WIDE, chromium
from builders import CHAIR, spec
from stage import Stage

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

SCOPED = spec(CHAIR, lam=0.2, depth=2, stimulus='chair')
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
