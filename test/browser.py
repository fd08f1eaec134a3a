"""A Chromium of this machine, without a window."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

_NAMES = ('chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable')
CHROMIUM = next(filter(None, map(shutil.which, _NAMES)), None)
needs_chromium = pytest.mark.skipif(
    CHROMIUM is None, reason='needs Chromium (Debian: apt-get install chromium)'
)
_FLAGS = [
    '--disable-gpu',
    '--disable-quic',
    '--no-first-run',
    '--disable-background-networking',
    '--disable-component-update',
    '--disable-sync',
]
DEADLINE_MS = 20_000
WIDE, NARROW = {'width': 1280, 'height': 900}, {'width': 400, 'height': 860}


@contextmanager
def chromium() -> Iterator[Browser]:
    """A browser with a profile of its own; it knows nothing, and leaves nothing."""
    from playwright.sync_api import expect, sync_playwright

    expect.set_options(timeout=DEADLINE_MS)
    flags = [*_FLAGS, '--no-sandbox'] if os.geteuid() == 0 else _FLAGS
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=flags)
        yield browser
        browser.close()


def point_of(page: Page, column: float, row: float) -> tuple[float, float]:
    """Where the middle of a cell of the tower is on the page [px]; column -1 is the row's number."""
    x, y = page.evaluate(
        """([column, row]) => {
            const svg = document.querySelector('#board svg');
            const height = svg.querySelectorAll('.row-label').length;
            const point = new DOMPoint(column + 0.5, height - row - 0.5);
            const {x, y} = point.matrixTransform(svg.getScreenCTM());
            return [x, y];
        }""",
        [column, row],
    )
    return x, y


def drag(page: Page, start: tuple[int, int], end: tuple[int, int]) -> None:
    """Draw a rectangle from a cell to another one, with the mouse."""
    page.mouse.move(*point_of(page, *start))
    page.mouse.down()
    page.mouse.move(*point_of(page, *end), steps=3)
    page.mouse.up()


def sees(page: Page, selector: str, text: str | re.Pattern[str]) -> None:
    """Wait until a part of the page holds a text."""
    from playwright.sync_api import expect

    expect(page.locator(selector)).to_be_visible()
    expect(page.locator(selector)).to_contain_text(text)


def count_of(page: Page, selector: str, count: int) -> None:
    """Wait until there are so many of something on the page."""
    from playwright.sync_api import expect

    expect(page.locator(selector)).to_have_count(count)


def press(page: Page, keys: str) -> None:
    """Press keys one after the other."""
    for key in keys.split():
        page.keyboard.press(key)
