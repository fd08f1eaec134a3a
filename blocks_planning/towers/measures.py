"""The measures of a tower by name, cheap ones first."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from blocks_planning.board.blocks import Placed
from blocks_planning.board.measures import Shape, shape_of
from blocks_planning.board.task import Task
from blocks_planning.search.exact import ExactAnswer, analyse
from blocks_planning.search.result import CancelToken
from blocks_planning.towers.candidates import Candidate
from blocks_planning.towers.difficulty import Planner, difficulty_of

Holds: TypeAlias = Callable[[Sequence[Placed]], bool]
"""Decides whether a tower of loose blocks is stable."""

EXACT = {
    'solvable': '1 if the blocks of the library can rebuild the tower, 0 if not',
    'blocks': 'fewest blocks that rebuild it, 0 if none do',
    'arrangements': 'number of arrangements that rebuild it',
    'optimal': 'number of arrangements with the fewest blocks',
}
LOOSE = {'loose': '1 if a known order of placing is stable with loose blocks throughout, 0 if not'}
DIFFICULTY = {
    'cost': 'mean states that a trial of the planner evaluates',
    'success': 'share of the trials of the planner that rebuild the tower',
}
SHAPE = dict.fromkeys(Shape._fields, 'see blocks_planning.board.measures')
NAMES = (*SHAPE, *EXACT, *LOOSE, *DIFFICULTY)


@dataclass(frozen=True)
class Instruments:
    """Instruments for measures that need a planner or statics.

    Attributes:
        planner: for the measures of difficulty; None to omit them.
        holds: statics, for the measure ``loose``; None to omit it.
    """

    planner: Planner | None = None
    holds: Holds | None = None


def measured(
    task: Task, candidate: Candidate, instruments: Instruments, cancel: CancelToken
) -> Iterator[Mapping[str, float]]:
    """The measures of a tower, group by group, so that later groups can be skipped.

    Raises:
        LimitExceeded: if the tower is too large for exact values.
    """
    yield shape_of(task.board, task.silhouette)._asdict()
    answer = analyse(task, cancel)
    if answer is None:
        return
    yield {
        'solvable': int(answer.fewest_blocks is not None),
        'blocks': answer.fewest_blocks or 0,
        'arrangements': answer.arrangements,
        'optimal': answer.optimal_arrangements,
    }
    if instruments.holds is not None:
        yield {'loose': int(_is_loose(candidate, answer, instruments.holds))}
    if instruments.planner is not None:
        difficulty = difficulty_of(task, instruments.planner, cancel)
        if difficulty is not None:
            yield difficulty


def _is_loose(candidate: Candidate, answer: ExactAnswer, holds: Holds) -> bool:
    """Whether one of the two known plans for the tower is stable after every block."""
    ways = (candidate.placements, answer.placements or ())
    return any(
        bool(way) and all(holds(way[:count]) for count in range(1, len(way) + 1)) for way in ways
    )
