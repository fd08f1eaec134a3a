"""The number of reachable states, without visiting them.

A set of filled cells is reachable if and only if it can be tiled by blocks each of which rests on
the ground or on at least one filled cell (see :mod:`.exact`). The sets are counted cell by cell,
row by row from the left. The continuations depend only on which cells of the last row are filled,
and on the sets of later cells that a tiling may already cover: the *profile*. Sets of filled cells
with the same profile are counted together. Each set is counted once, however many tilings it has.
"""

from __future__ import annotations

from typing import NamedTuple

from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.errors import LimitExceeded
from blocks_planning.search.result import CancelToken

MAX_PROFILES = 500_000
"""Largest number of profiles stored at one cell."""
_CHECK_EVERY = 1024


class Profile(NamedTuple):
    """The properties of filled cells that determine how they can be continued."""

    below: Mask  # filled cells on which later blocks of this row or the next can rest
    claims: frozenset[Mask]  # undecided cells that blocks cover, for every tiling


class _Rectangle(NamedTuple):
    cells: Mask
    support: Mask  # the cells right below it; none on the ground


class _Claims(NamedTuple):
    """The claims after a cell, for each decision."""

    empty: frozenset[Mask]
    filled: frozenset[Mask]


_Counts = dict[Profile, int]


def count_states(
    task: Task, limit: int = MAX_PROFILES, cancel: CancelToken | None = None
) -> int | None:
    """Number of different sets of filled cells that legal placements reach; None if cancelled.

    The empty board is one of them.

    Raises:
        LimitExceeded: if more than ``limit`` profiles would be stored.
    """
    board, cancel = task.board, cancel or CancelToken()
    counts: _Counts = {Profile(0, frozenset([0])): 1}
    for row in range(board.height):
        for column in range(board.width):
            cell = board.mask([(column, row)])
            if cell & task.silhouette:
                following = _decide(counts, cell, _rectangles(task, column, row), cancel)
                if following is None:
                    return None
                counts = following
            if len(counts) > limit:
                raise LimitExceeded(
                    f'the states of this silhouette of {board.width} x {board.height} cells have '
                    f'more than the limit of {limit} profiles'
                )
            if row:
                counts = _forget(counts, board.mask([(column, row - 1)]))
    return sum(number for profile, number in counts.items() if 0 in profile.claims)


def _rectangles(task: Task, column: int, row: int) -> list[_Rectangle]:
    """The blocks that can have their lower left cell at a place."""
    board, found = task.board, []
    for width, height in task.library:
        if column + width > board.width or row + height > board.height:
            continue
        cells = board.rectangle(column, row, width, height)
        if not cells & ~task.silhouette:
            support = board.rectangle(column, row - 1, width, 1) if row else 0
            found.append(_Rectangle(cells, support))
    return found


def _decide(
    counts: _Counts, cell: Mask, rectangles: list[_Rectangle], cancel: CancelToken
) -> _Counts | None:
    """The profiles after a cell, filled or empty; None if cancelled."""
    following: _Counts = {}
    decided: dict[tuple[frozenset[Mask], tuple[Mask, ...]], _Claims] = {}
    for index, ((below, claims), number) in enumerate(counts.items()):
        if index % _CHECK_EVERY == 0 and cancel.cancelled:
            return None
        standing = tuple(cells for cells, support in rectangles if not support or support & below)
        found = decided.get((claims, standing))
        if found is None:
            found = decided[claims, standing] = _claims_after(claims, cell, standing)
        for profile in (Profile(below, found.empty), Profile(below | cell, found.filled)):
            if profile.claims:
                following[profile] = following.get(profile, 0) + number
    return following


def _claims_after(claims: frozenset[Mask], cell: Mask, standing: tuple[Mask, ...]) -> _Claims:
    """The claims after a cell at which the blocks ``standing`` can have their lower left cell."""
    empty = frozenset(claim for claim in claims if not claim & cell)
    covered = frozenset(claim & ~cell for claim in claims if claim & cell)
    placed = frozenset(
        (claim | cells) & ~cell for claim in empty for cells in standing if not claim & cells
    )
    return _Claims(empty, covered | placed)


def _forget(counts: _Counts, cell: Mask) -> _Counts:
    """The profiles when no later block can rest on a cell: whether it is filled does not matter."""
    following: _Counts = {}
    for (below, claims), number in counts.items():
        profile = Profile(below & ~cell, claims)
        following[profile] = following.get(profile, 0) + number
    return following
