"""The conclusions in words: does the advantage of looking one subgoal ahead grow with uncertainty?

The sentences are generated from the intervals of :mod:`.uncertainty`, so they follow the numbers of
every run.
"""

from __future__ import annotations

from typing import Any

from blocks_planning.analysis.uncertainty import FAR, NEAR

THINGS = {
    'success': ('success', 'success minus that of full planning, in points'),
    'log2_cost_ratio': ('cost', 'states of full planning divided by its own'),
}


def answers(results: dict[str, Any]) -> list[str]:
    """Sentences for each scoping planner, and the reasons."""
    planners = sorted({row['planner'] for row in results['advantage']})
    sentences = []
    for planner in planners:
        rows = [row for row in results['advantage'] if row['planner'] == planner]
        sentences.append(
            f'{planner}: {_change(rows, "success")}; {_change(rows, "log2_cost_ratio")}.'
        )
    return [*sentences, *_reasons(results)]


def first_change(rows: list[dict[str, Any]], thing: str) -> tuple[float, int] | None:
    """The lowest slip from which on an advantage differs from slip 0, and the sign of the change.

    At this slip and every higher one the interval of the change excludes 0, on the same side.
    None if there is no such slip.
    """
    found = None
    for row in sorted(rows, key=lambda one: -float(one['slip'])):
        low, high = row[f'{thing}_change']['ci']
        sign = (low > 0) - (high < 0)
        if sign == 0 or (found is not None and found[1] != sign):
            break
        found = (float(row['slip']), sign)
    return found


def _change(rows: list[dict[str, Any]], thing: str) -> str:
    first, last = rows[0], rows[-1]
    name, _ = THINGS[thing]
    found = first_change(rows, thing)
    ends = f'{_shown(first[thing], thing)} at slip 0, {_shown(last[thing], thing)} at {last["slip"]:g}'
    if found is None:
        return f'its advantage in {name} does not change measurably ({ends})'
    word = 'grows' if found[1] > 0 else 'shrinks'
    return f'its advantage in {name} {word} from slip {found[0]:g} on ({ends})'


def _shown(estimate: dict[str, Any], thing: str) -> str:
    mean, (low, high) = estimate['mean'], estimate['ci']
    if thing == 'success':
        return f'{100 * mean:+.1f} points [{100 * low:+.1f}, {100 * high:+.1f}]'
    return f'{2**mean:.2f} times [{2**low:.2f}, {2**high:.2f}]'


def _reasons(results: dict[str, Any]) -> list[str]:
    cells = {
        (cell['planner'], cell['slip']): cell
        for cell in results['cells']
        if cell['loss'] == 0 and cell['blocks_are'] == 'glued'
    }
    slips = sorted({slip for _, slip in cells})
    shown = []
    for planner in sorted({planner for planner, _ in cells}):
        if planner == FAR or planner.startswith(NEAR):
            ends = [cells[planner, slip] for slip in (slips[0], slips[-1])]
            blocks, plans = (
                ' and '.join(f'{cell[name]["mean"]:.1f}' for cell in ends)
                for name in ('blocks', 'plans')
            )
            shown.append(f'{planner} places {blocks} blocks and makes {plans} plans')
    return [f'Per trial at slip {slips[0]:g} and {slips[-1]:g}: {"; ".join(shown)}.']
