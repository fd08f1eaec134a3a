"""What a participant does in a trial: proposes regions, or places blocks.

Both are trials of the strategy ``human``, so both leave ordinary trial records. Who builds, proposes
the cells of one block at a time. The search for it looks one block ahead in one attempt, so the only
plan that fills these cells is that block.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple, TypeAlias

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placement
from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.search.result import Problem
from blocks_planning.search.searches import Search, make_search
from blocks_planning.search.solve import solve
from blocks_planning.subgoals.drawn import (
    MalformedProposal,
    Refused,
    judge_region,
    parse_region,
)
from blocks_planning.subgoals.proposals import ProposalKind

Fields: TypeAlias = Mapping[str, Any]


class Wish(NamedTuple):
    """A request of a participant in a state, and the reason to refuse it; None if there is none."""

    kind: ProposalKind
    region: Mask
    refused: Refused | None = None


Reader: TypeAlias = Callable[[Task, Mask, Fields], Wish]
"""Reads a wish from what a page sent about a state; raises MalformedProposal."""


class Effort(NamedTuple):
    """How it is found out whether a region can be filled: a search, and its budget [states]."""

    search: Search
    budget: int

    def prepare(self, task: Task) -> None:
        """Solve a task in one attempt, so that the search is compiled before it is needed."""
        solve(Problem(task, 0, task.silhouette), self.search, 0, 0)


class Mode(NamedTuple):
    """A kind of trial.

    Attributes:
        name: in the file of a study.
        wishes: what can be asked for, by the word that a page sends.
        effort: of its trials, given that of the study.
    """

    name: str
    wishes: Mapping[str, Reader]
    effort: Callable[[Effort], Effort]


def _drawn(task: Task, built: Mask, fields: Fields) -> Wish:
    region = parse_region(fields.get('region'), task.board)
    return Wish(ProposalKind.BUILD, region, judge_region(task, built, region))


def _withdrawn(task: Task, built: Mask, fields: Fields) -> Wish:
    return Wish(ProposalKind.WITHDRAWN, parse_region(fields.get('region'), task.board))


def _given_up(task: Task, built: Mask, fields: Fields) -> Wish:
    return Wish(ProposalKind.GIVE_UP, 0)


def _placed(task: Task, built: Mask, fields: Fields) -> Wish:
    block = _whole(fields, 'block', len(task.library))
    column = _whole(fields, 'column', task.board.width)
    placed = rules.drop(task.board, built, Placement(task.library[block], column))
    if placed is None:
        refused = Refused('no_room', 'the block does not fit into the picture there')
        return Wish(ProposalKind.BUILD, 0, refused)
    cells = rules.cells_of(task.board, placed)
    if cells & ~task.silhouette:
        return Wish(
            ProposalKind.BUILD,
            cells,
            Refused('sticks_out', 'the block would stick out of the silhouette'),
        )
    return Wish(ProposalKind.BUILD, cells)


def _whole(fields: Fields, key: str, count: int) -> int:
    value = fields.get(key)
    if type(value) is not int or not 0 <= value < count:
        raise MalformedProposal(f'{key}: expected a number from 0 to {count - 1}, got {value!r}')
    return value


_GIVE_UP = {ProposalKind.GIVE_UP.value: _given_up}
SCOPING = Mode(
    'scoping',
    MappingProxyType({'build': _drawn, 'withdrawn': _withdrawn, **_GIVE_UP}),
    lambda effort: effort,
)
BUILDING = Mode(
    'building',
    MappingProxyType({'place': _placed, **_GIVE_UP}),
    lambda _: Effort(make_search('bfs', {'depth': 1}), 0),
)
MODES: Mapping[str, Mode] = MappingProxyType({mode.name: mode for mode in (SCOPING, BUILDING)})
