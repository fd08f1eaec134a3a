"""The problem of a solve, its result, and its cancellation."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.errors import InvalidInput

DEFAULT_BUDGET = 100_000
"""The paper's budget b [states]."""
MAX_BUDGET = (1 << 63) - 1
MAX_DEPTH = 64
"""Largest depth of a lookahead [placements]."""


class SolveStatus(str, Enum):
    """How a solve ended.

    ``limit_exceeded``: the search would have exceeded its memory limit, so it is unknown whether
    the region can be filled.
    """

    SOLVED = 'solved'
    UNSOLVABLE_PROVEN = 'unsolvable_proven'
    BUDGET_EXHAUSTED = 'budget_exhausted'
    LIMIT_EXCEEDED = 'limit_exceeded'
    CANCELLED = 'cancelled'


@dataclass(frozen=True)
class Problem:
    """Fill ``region``, and nothing else, from the state in which ``built`` is filled.

    ``blocks`` are those that fill ``built``, for searches that plan on blocks; other searches
    ignore them.

    Raises:
        InvalidInput: if the region has cells off the board, or does not contain the built cells.
    """

    task: Task
    built: Mask
    region: Mask
    blocks: tuple[Placed, ...] = ()

    def __post_init__(self) -> None:
        if not 0 <= self.region <= self.task.board.full:
            raise InvalidInput(f'region {self.region:#x} has cells off the board')
        if self.built & ~self.region or self.built < 0:
            raise InvalidInput(
                f'region {self.region:#x} must contain the built cells {self.built:#x}'
            )


@dataclass(frozen=True)
class SolveResult:
    """The result of a solve. Costs are states evaluated, as the search defines them.

    Attributes:
        status: how it ended; only ``solved`` comes with placements (or with none needed).
        placements: from the problem's state to its filled region, in order.
        solution_cost: states evaluated in the attempt that succeeded; 0 if none did.
        planning_cost: states evaluated in all attempts.
        attempts: number of attempts made; 0 where no search was needed.
        last_attempt: placements of the last attempt if none succeeded, as far as it came.
    """

    status: SolveStatus
    placements: tuple[Placed, ...] = ()
    solution_cost: int = 0
    planning_cost: int = 0
    attempts: int = 0
    last_attempt: tuple[Placed, ...] = ()

    @property
    def plan(self) -> tuple[Placed, ...]:
        """The placements to carry out: those that fill the region, otherwise the last attempt."""
        return self.placements if self.solved else self.last_attempt

    @property
    def solved(self) -> bool:
        """Whether the placements fill the region."""
        return self.status is SolveStatus.SOLVED


class CancelToken:
    """Stops running solves, from any thread."""

    def __init__(self) -> None:
        """Create a token that is not cancelled."""
        self.flag = np.zeros(1, np.uint8)

    def cancel(self) -> None:
        """Make every solve that holds this token end as ``cancelled``, within 0.1 s."""
        self.flag[0] = 1

    @property
    def cancelled(self) -> bool:
        """Whether :meth:`cancel` was called."""
        return bool(self.flag[0])
