"""People who take part in a study, on a page in a browser: with a mouse, a finger or the keyboard."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from browser import drag, point_of

if TYPE_CHECKING:
    from playwright.sync_api import Page


def stage_of(page: Page) -> str:
    """Wait until the page shows a step; tell which."""
    return str(
        page.evaluate("""async () => {
            const shown = (id) => document.getElementById(id)?.checkVisibility();
            const stages = {agree: 'consent', 'go-on': 'text', marking: 'marking', scoping: 'scoping',
                building: 'building', next: 'ended'};
            for (;;) {
                for (const [id, stage] of Object.entries(stages)) if (shown(id)) return stage;
                if (/is over|did not agree/.test(document.getElementById('text').textContent)) return 'over';
                await new Promise(requestAnimationFrame);
            }
        }""")
    )


TRIED = re.compile('It is built|There is no way')


def sees(page: Page, selector: str, text: str | re.Pattern[str]) -> None:
    from playwright.sync_api import expect

    expect(page.locator(selector)).to_contain_text(text)


class Participant:
    """A participant who goes through a study on a page with the mouse."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.seen: list[str] = []

    def go_on(self) -> str:
        """Do what leads on from what the page shows; tell what that was."""
        stage = stage_of(self.page)
        self.seen.append(stage)
        if stage == 'scoping':
            self.scope()
        elif stage == 'building':
            self.build()
        elif stage == 'marking':
            self.mark()
            self.leave_step()
        elif stage != 'over':
            self.leave_step()
        return stage

    def leave_step(self) -> None:
        """Press what leads to the next step, and wait for it."""
        buttons = {'consent': 'I agree', 'text': '#go-on', 'marking': '#next', 'ended': '#next'}
        bar = self.page.locator('#progress-bar')
        step = bar.get_attribute('value')
        button = buttons[stage_of(self.page)]
        if button.startswith('#'):
            button = str(self.page.locator(button).text_content())
        self.press(button)
        self.page.wait_for_function(
            "step => document.getElementById('progress-bar').getAttribute('value') !== step",
            arg=step,
        )

    def press(self, name: str) -> None:
        self.page.get_by_role('button', name=name, exact=True).click()

    def mark(self) -> None:
        """The lower rows, the whole by mistake, the same taken back, then the left half, and the rest."""
        self.page.mouse.click(*point_of(self.page, -1, 1))
        self.press('This is a part')
        sees(self.page, '#preview', 'left that')
        drag(self.page, (0, 0), (7, 7))
        self.press('This is a part')
        sees(self.page, '#answer', 'Every cell')
        self.press('Take the last part back')
        sees(self.page, '#preview', 'left that')
        drag(self.page, (0, 0), (3, 7))
        self.press('This is a part')
        sees(self.page, '#preview', 'left that')
        drag(self.page, (0, 0), (7, 7))
        self.press('This is a part')
        sees(self.page, '#answer', 'Every cell')

    def scope(self) -> None:
        """Two rows, then everything."""
        self.page.mouse.click(*point_of(self.page, -1, 1))
        sees(self.page, '#preview', 'to fill')
        self.press('Build this')
        sees(self.page, '#answer', TRIED)
        drag(self.page, (0, 0), (7, 7))
        self.press('Withdraw')
        sees(self.page, '#answer', 'Withdrawn')
        self.give_up()

    def build(self) -> None:
        """Drag a block to the middle, let another one fall, then give up."""
        piece = self.page.locator('.piece').nth(0)
        piece.hover()
        self.page.mouse.down()
        self.page.mouse.move(*point_of(self.page, 5, 4), steps=4)
        self.page.mouse.up()
        self.page.locator('.block').wait_for()
        self.give_up()

    def give_up(self) -> None:
        self.press('Give up this tower…')
        self.press('Yes')
        self.page.locator('#next').wait_for()


class Finger(Participant):
    """The same with a finger."""

    def build(self) -> None:
        box = self.page.locator('.piece').nth(0).bounding_box()
        assert box is not None
        start = box['x'] + box['width'] / 2, box['y'] + box['height'] / 2
        touch = self.page.context.new_cdp_session(self.page)
        for kind, place in (
            ('touchStart', start),
            ('touchMove', point_of(self.page, 5, 2)),
            ('touchEnd', None),
        ):
            points = [] if place is None else [dict(zip('xy', place, strict=True))]
            touch.send('Input.dispatchTouchEvent', {'type': kind, 'touchPoints': points})
        self.page.locator('.block').wait_for()
        self.give_up()


class Keyboard(Participant):
    """The same with the keyboard alone."""

    def press(self, name: str) -> None:
        button = self.page.get_by_role('button', name=name, exact=True)
        self.tab_to(button)
        self.page.keyboard.press('Enter')

    def tab_to(self, place: Any) -> None:
        """Press Tab until something has the focus."""
        for _ in range(40):
            if place.evaluate('e => e === document.activeElement'):
                return
            self.page.keyboard.press('Tab')
        raise AssertionError(f'the keyboard does not reach {place}')

    def keys(self, keys: str) -> None:
        self.tab_to(self.page.locator('#board'))
        for key in keys.split():
            self.page.keyboard.press(key)

    def mark(self) -> None:
        self.keys('ArrowDown ' * 7 + 'r Enter')
        sees(self.page, '#preview', 'left that')
        self.keys('ArrowUp ' * 7 + 'r Enter')
        sees(self.page, '#answer', 'Every cell')

    def scope(self) -> None:
        self.keys('ArrowUp r')
        sees(self.page, '#preview', 'to fill')
        self.keys('Enter')
        sees(self.page, '#answer', TRIED)
        self.give_up()

    def build(self) -> None:
        self.keys('1 ' + 'ArrowRight ' * 6 + 'Enter')
        self.page.locator('.block').wait_for()
        self.give_up()
