"""Captions of a tower: words and numbers, the same in every view."""

from __future__ import annotations

import heapq
from collections.abc import Iterable, Iterator, Sequence
from math import inf
from typing import Any

from blocks_planning.search.result import SolveStatus
from blocks_planning.settings import described
from blocks_planning.subgoals.decision import Candidate, Decision
from blocks_planning.subgoals.regions import Region
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view import palette
from blocks_planning.view.palette import Signs
from blocks_planning.view.scene import Scene

STATUS_WORDS = {
    TrialStatus.BUILDING: 'building',
    TrialStatus.SUCCESS: 'success',
    TrialStatus.STUCK: 'stuck',
    TrialStatus.COLLAPSED: 'collapsed',
    TrialStatus.GAVE_UP: 'gave up',
    TrialStatus.CANCELLED: 'cancelled',
}

SOLVE_WORDS = {
    SolveStatus.SOLVED: 'solved',
    SolveStatus.UNSOLVABLE_PROVEN: 'unsolvable',
    SolveStatus.BUDGET_EXHAUSTED: 'exhausted',
    SolveStatus.LIMIT_EXCEEDED: 'too large',
    SolveStatus.CANCELLED: 'cancelled',
}


def stimulus_of(spec: TrialSpec, width: int, signs: Signs = palette.UNICODE) -> str:
    """The name of the silhouette on one line of at most ``width`` characters, its end kept."""
    name = signs.shown(spec.stimulus)
    return name if len(name) <= width else signs.more + name[len(name) + 1 - width :]


def strategy_of(spec: TrialSpec) -> str:
    """The subgoal planner with its settings, such as 'scoping, lambda 0.002'."""
    return _with_settings(spec.strategy)


def search_of(spec: TrialSpec) -> str:
    """The search with its settings, such as 'bfs, depth 3'."""
    return _with_settings(spec.search)


def _with_settings(thing: Any) -> str:
    """A name with its first setting, if that is a number, and all settings without the default."""
    return ', '.join([thing.name, *_settings(thing)])


def _settings(thing: Any) -> Iterator[str]:
    for number, (attribute, known) in enumerate(described(type(thing))):
        value = getattr(thing, attribute)
        if known.family is not None:
            value = value.name
        is_main = number == 0 and isinstance(value, (int, float))
        if is_main or value != known.default:
            text = f'{value:,}' if isinstance(value, int) else f'{value}'
            yield f'{known.name} {text}'


def counted(count: int, noun: str) -> str:
    """A number of things, such as '1 block' or '1,200 blocks'."""
    return f'{count:,} {noun}{"" if count == 1 else "s"}'


def progress_of(scene: Scene) -> str:
    """The progress, such as '12 blocks, 3 subgoals'."""
    record = scene.record
    return f'{counted(record.blocks, "block")}, {counted(record.subgoals, "subgoal")}'


def costs_of(scene: Scene) -> str:
    """Both planning costs, such as 'action planning 120, subgoal planning 4,839 [states]'."""
    record = scene.record
    return (
        f'action planning {record.action_planning_cost:,}, '
        f'subgoal planning {record.subgoal_planning_cost:,} [states]'
    )


def heading_of(scene: Scene, width: int, signs: Signs = palette.UNICODE) -> list[str]:
    """The heading of a picture: stimulus and status, strategy, search, progress, costs.

    Args:
        scene: the scene.
        width: largest width of the first line [characters].
        signs: the characters of the terminal.
    """
    spec, status = scene.spec, STATUS_WORDS[scene.status]
    return [
        f'{stimulus_of(spec, width - len(status), signs)}: {status}',
        strategy_of(spec),
        search_of(spec),
        progress_of(scene),
        costs_of(scene),
    ]


def outcome_of(scene: Scene, signs: Signs = palette.UNICODE) -> str:
    """One line that says how a trial ended."""
    name = signs.shown(scene.spec.stimulus)
    return f'{name}: {STATUS_WORDS[scene.status]}, {progress_of(scene)}, {costs_of(scene)}'


def shortlist(decision: Decision, most: int) -> list[int]:
    """Indices of the candidates to show, in the order in which to show them.

    All of them in their order, if they are ``most`` or fewer; otherwise the chosen one and the best
    of the rest, by value.
    """
    candidates = decision.candidates
    if len(candidates) <= most:
        return list(range(len(candidates)))

    def rank(index: int) -> tuple[bool, float, int]:
        value = candidates[index].value
        return index != decision.chosen, inf if value is None else -value, index

    return heapq.nsmallest(most, range(len(candidates)), key=rank)


def numbers_of(candidate: Candidate) -> list[str]:
    """r, c, V and status of a candidate, as the columns of a table."""
    value = candidate.value
    if value is None:
        worth = '-'
    else:
        worth = f'{value:,.2f}' if abs(value) < 1000 else f'{value:,.0f}'
    return [
        f'{candidate.cells:,}',
        f'{candidate.planning_cost:,}',
        worth,
        SOLVE_WORDS[candidate.status],
    ]


def common_kind(candidates: Sequence[Candidate]) -> str:
    """The common kind of the labels of some candidates; '' if there are several kinds, or none."""
    kinds = {region.label.kind for candidate in candidates for region in candidate.regions}
    return kinds.pop() if len(kinds) == 1 else ''


def regions_of(
    candidate: Candidate, width: int, signs: Signs = palette.UNICODE, kind: str = ''
) -> str:
    """The labels of a candidate's regions in at most ``width`` characters; the last ones are cut.

    Args:
        candidate: the candidate.
        width: largest width [characters].
        signs: the characters of the terminal.
        kind: omitted from labels, because a heading names it.

    >>> from blocks_planning.subgoals.regions import Label
    >>> rows = [Region(Label('rows', (height,)), 0) for height in (1, 3, 8)]
    >>> regions_of(Candidate(tuple(rows), 9, 9, None, SolveStatus.SOLVED), width=10)
    'rows 1 3 8'
    >>> regions_of(Candidate(tuple(rows), 9, 9, None, SolveStatus.SOLVED), 4, kind='rows')
    '1 3…'
    """
    text = chain_text(candidate.regions, kind)
    if len(text) <= width:
        return text
    return text[:width].rpartition(' ')[0] + signs.more


def chain_text(regions: Iterable[Region], kind: str = '') -> str:
    """The labels of regions; a kind is named once for several regions in a row.

    >>> from blocks_planning.subgoals.regions import Label
    >>> chain_text([Region(Label('rows', (2,)), 0), Region(Label('rectangle', (0, 2, 3, 1)), 0)])
    'rows 2 rectangle 0,2,3,1'
    """
    words: list[str] = []
    for label, _ in regions:
        words.append(str(label).removeprefix(f'{kind} ') if label.kind == kind else str(label))
        kind = label.kind
    return ' '.join(words)
