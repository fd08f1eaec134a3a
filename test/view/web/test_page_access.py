"""The page in a real browser: it can be read and used by everybody."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import pytest
from browser import count_of, drag, needs_chromium, press, sees
from heard_trials import human_spec
from page_fixture import SCOPED, Opener
from stage import Stage

from blocks_planning.view.web.health import NOTHING, health_after

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = needs_chromium


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
