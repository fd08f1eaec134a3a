"""Tables of trials."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from statistics import fmean
from typing import Literal

from rich import box
from rich.cells import cell_len
from rich.console import Console
from rich.table import Table
from rich.text import Text

from blocks_planning.settings import settings_of
from blocks_planning.subgoals.proposals import ProposalKind
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import FAMILIES, TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view.names import broken

_NUMBERS_OF_PROPOSALS = 50
"""Width of the columns of numbers in the table of proposals [characters]."""
_COLUMNS = ('blocks', 'subgoals', 'action cost', 'subgoal cost', 'solution cost')


def print_summaries(records: Sequence[TrialRecord], console: Console | None = None) -> None:
    """Print a summary for each planner, in the order of first appearance."""
    by_planner: dict[str, list[TrialRecord]] = {}
    for record in records:
        by_planner.setdefault(_planner(record), []).append(record)
    for group in by_planner.values():
        print_summary(group, console)


def print_summary(records: Sequence[TrialRecord], console: Console | None = None) -> None:
    """Print a row per stimulus: its only trial, or means over its successful trials.

    Costs are states evaluated; those of action and subgoal planning count every attempt.
    """
    console = console or Console()
    groups = [list(group) for _, group in groupby(records, lambda r: r.spec.stimulus)]
    single = all(len(group) == 1 for group in groups)
    table = Table(
        box=box.SIMPLE_HEAD,
        padding=(0, 1, 0, 0),
        caption=_caption(records, single),
        caption_justify='left',
    )
    # Numbers are never cut. A long name uses the remaining width, on several lines.
    rows = [_row(group, single) for group in groups]
    titles = ['status' if single else 'success', *_COLUMNS]
    widths = [
        max(len(text) for text in (*title.split(), *(row[index] for row in rows)))
        for index, title in enumerate(titles, start=1)
    ]
    longest = max(cell_len(text) for text in ('stimulus', *(row[0] for row in rows)))
    room = console.width - sum(widths) - 2 * (len(titles) + 1) - 1
    width = max(8, min(longest, room))
    table.add_column('stimulus', overflow='fold', width=width)
    for title, size in zip(titles, widths, strict=True):
        justify: Literal['left', 'right'] = 'right' if title in _COLUMNS else 'left'
        table.add_column(title, justify=justify, width=size)
    for stimulus, *rest in rows:
        table.add_row(Text(broken(stimulus, width)), *rest)
    console.print(_planner(records[0]), highlight=False)
    console.print(table)


def print_proposals(records: Sequence[TrialRecord], console: Console | None = None) -> None:
    """Print the proposals of each trial of a person; nothing if there is none.

    Thinking time is the time before each proposal, withdrawn ones included [s].
    """
    table = Table(
        title='Proposals; thinking time in seconds, total and mean',
        title_justify='left',
        title_style='',
        box=box.SIMPLE_HEAD,
        padding=(0, 1, 0, 0),
    )
    table.add_column('participant', overflow='fold')
    table.add_column('stimulus', overflow='fold')
    for title in ('proposed', 'built', 'withdrawn', 'thinking', 'each'):
        table.add_column(title, justify='right', no_wrap=True)
    console = console or Console()
    room = max(8, (console.width - _NUMBERS_OF_PROPOSALS) // 2)
    for record in records:
        if record.spec.strategy.asks_person:
            participant = str(settings_of(record.spec.strategy).get('participant', ''))
            names = (broken(name, room) for name in (participant, record.spec.stimulus))
            table.add_row(*map(Text, [*names, *_proposed(record)]))
    if table.row_count:
        console.print(table)


def _proposed(record: TrialRecord) -> list[str]:
    """Numbers of regions proposed, built and withdrawn, and the thinking time."""
    kinds = [proposal.kind for proposal in record.proposals]
    seconds = [proposal.thinking_s for proposal in record.proposals]
    return [
        str(kinds.count(ProposalKind.BUILD)),
        str(record.subgoals),
        str(kinds.count(ProposalKind.WITHDRAWN)),
        f'{sum(seconds):.1f}',
        f'{fmean(seconds):.1f}' if seconds else '-',
    ]


def _planner(record: TrialRecord) -> str:
    """Strategy, search and world with all their settings."""
    return ', '.join(_member(name, record.spec) for name in FAMILIES)


def _member(family: str, spec: TrialSpec) -> str:
    chosen = getattr(spec, family)
    values = ', '.join(f'{key} {value}' for key, value in settings_of(chosen).items())
    return f'{family} {chosen.name}' + (f' ({values})' if values else '')


def _row(group: list[TrialRecord], single: bool) -> list[str]:
    done = group if single else [r for r in group if r.status is TrialStatus.SUCCESS]
    status = group[0].status.value if single else f'{len(done)}/{len(group)}'
    columns = zip(*(_numbers(record) for record in done), strict=True)
    means = [_mean(column) for column in columns] or ['-'] * len(_COLUMNS)
    return [group[0].spec.stimulus, status, *means]


def _numbers(record: TrialRecord) -> tuple[int, ...]:
    return (
        record.blocks,
        record.subgoals,
        record.action_planning_cost,
        record.subgoal_planning_cost,
        record.solution_cost,
    )


def _mean(numbers: Sequence[int]) -> str:
    mean = fmean(numbers)
    return f'{mean:,.0f}' if mean == int(mean) or mean >= 100 else f'{mean:.1f}'


def _caption(records: Sequence[TrialRecord], single: bool) -> str:
    successes = sum(record.status is TrialStatus.SUCCESS for record in records)
    share = f'{successes} of {len(records)} trials rebuilt the tower perfectly.'
    what = 'Costs are states evaluated' + (
        '.' if single else ', means over the successful trials.'
    )
    return f'{share} {what}'
