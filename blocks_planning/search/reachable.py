"""The states from which a region can still be filled: found once, then addressed by number."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from blocks_planning.board import rules
from blocks_planning.board.geometry import Mask, area
from blocks_planning.board.kernels.masks import pack
from blocks_planning.errors import LimitExceeded
from blocks_planning.search.compiled import tables_of
from blocks_planning.search.kernels.states import DEAD, Space, expand, fill_slots, number_of
from blocks_planning.search.result import CancelToken, Problem

MAX_STATES = 2_000_000
"""Default of the largest number of stored states: about 0.4 GB at six slips."""
_STATES_PER_STEP = 50_000
_STATES_AT_FIRST = 1 << 14

Report = Callable[[str, int, int], None]
"""Called with the name of the stage, the number of finished states, and that of known states."""


def say_nothing(stage: str, done: int, known: int) -> None:
    """Report no progress."""


class Reachable:
    """Every alive state (see :mod:`.kernels.states`) that legal placements lead to.

    Attributes:
        problem: state and region.
        space: the states by number, for kernels.
        falling: their numbers by falling number of filled cells, without the complete state,
            int64 (n,).
        complete: number of the complete state; 0 if it can't be reached.
    """

    def __init__(self, problem: Problem, space: Space) -> None:
        """Use a space in which every state has been expanded."""
        self.problem = problem
        self.space = space
        count = self.count
        filled = space.filled[1:count]
        order = 1 + np.argsort(-filled, kind='stable').astype(np.int64)
        whole = space.filled[order] == area(problem.region)
        self.falling = np.ascontiguousarray(order[~whole])
        self.complete = int(order[whole][0]) if whole.any() else DEAD

    @property
    def count(self) -> int:
        """Number of used numbers: those of the states, and 0 for states that are not alive."""
        return int(self.space.used[0])

    def number(self, built: Mask) -> int:
        """The number of the state in which ``built`` is filled; 0 if it is not alive here."""
        board, region = self.problem.task.board, self.problem.region
        if built & ~region or rules.is_dead(board, built, region):
            return DEAD
        shadow = rules.shadow(board, built)
        return int(number_of(self.space, pack([shadow], board.size)))


def find_reachable(
    problem: Problem,
    limit: int = MAX_STATES,
    cancel: CancelToken | None = None,
    report: Report = say_nothing,
) -> Reachable | None:
    """Find the states from which the region can still be filled; None if cancelled.

    Args:
        problem: state and region.
        limit: largest number of states; each takes about 20 bytes, and 16 more for every slip
            that is analysed.
        cancel: ends it from another thread.
        report: called with the progress.

    Raises:
        LimitExceeded: if there are more states than ``limit``.
    """
    cancel = cancel or CancelToken()
    space = _first_space(problem)
    looked_at = 1
    while looked_at < (known := int(space.used[0])):
        if known - 1 > limit:
            raise _too_large(problem, limit)
        report('states', looked_at - 1, known - 1)
        before = looked_at
        looked_at = expand(space, before, _STATES_PER_STEP, cancel.flag)
        if cancel.cancelled:
            return None
        if looked_at == before:
            space = _with_room(space)
    if known - 1 > limit:
        raise _too_large(problem, limit)
    return Reachable(problem, space)


def _first_space(problem: Problem) -> Space:
    """A space with the problem's own state, if it is alive."""
    board = problem.task.board
    tables = tables_of(problem.task, problem.region)
    children = board.width * len(tables.area)
    size = max(_STATES_AT_FIRST, 4 * children)
    mask_shape = tables.legal.shape[1:]
    space = Space(
        tables=tables,
        possible=tables_of(problem.task, board.full),
        height=board.height,
        region=pack([problem.region], board.size),
        shadow=np.zeros((size, *mask_shape), np.uint64),
        filled=np.zeros(size, np.int32),
        slots=np.zeros(_slots_for(size), np.int32),
        used=np.ones(1, np.int64),
        places=np.zeros_like(tables.legal),
        child=np.zeros(board.width + 2, np.int64),
        legal=np.zeros(board.width + 2, np.uint8),
    )
    if not rules.is_dead(board, problem.built, problem.region):
        space.shadow[1] = pack([rules.shadow(board, problem.built)], board.size)[0]
        space.filled[1] = area(problem.built)
        space.used[0] = 2
        fill_slots(space)
    return space


def _with_room(space: Space) -> Space:
    """The same states with room for twice as many."""
    size = 2 * len(space.filled)
    larger = space._replace(
        shadow=np.concatenate([space.shadow, np.zeros_like(space.shadow)]),
        filled=np.concatenate([space.filled, np.zeros_like(space.filled)]),
        slots=np.zeros(_slots_for(size), np.int32),
    )
    fill_slots(larger)
    return larger


def _slots_for(size: int) -> int:
    return 1 << (2 * size - 1).bit_length()


def _too_large(problem: Problem, limit: int) -> LimitExceeded:
    board = problem.task.board
    return LimitExceeded(
        f'more than the limit of {limit} states can be reached on this silhouette of '
        f'{board.width} x {board.height} cells'
    )
