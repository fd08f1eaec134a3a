"""The history of a board: what was ordered and what was observed.

A planner orders a placement. The world observes which blocks are where. The observation counts,
even if it differs from the order. Observations of a trial are numbered from 0, the board before the
first order; the number of the latest is the *sequence* of the state.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import reduce
from typing import NamedTuple

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed, Placement
from blocks_planning.board.geometry import Board, Mask

MAX_OBSERVATIONS = 1024
"""Most observations of a trial, the first included; a trial that would need more ends."""

Blocks = tuple[Placed, ...]
"""The blocks that stand, in the order in which they landed."""


class Observation(NamedTuple):
    """What changed on the board since the observation before.

    Attributes:
        ordered: the placement that was ordered; None if the board changed by itself.
        landed: blocks that stand now and did not before.
        gone: blocks that stood before and do not now. A block that moved is in both.
    """

    ordered: Placement | None = None
    landed: Blocks = ()
    gone: Blocks = ()

    @property
    def is_as_ordered(self) -> bool:
        """Whether the ordered block, and nothing else, landed in the ordered column."""
        if self.ordered is None or self.gone or len(self.landed) != 1:
            return False
        width, height, column, _ = self.landed[0]
        return self.ordered == ((width, height), column)


Observations = tuple[Observation, ...]


def blocks_after(blocks: Blocks, observation: Observation) -> Blocks:
    """The blocks that stand after an observation."""
    if observation.gone:
        gone = set(observation.gone)
        blocks = tuple(block for block in blocks if block not in gone)
    return blocks + observation.landed


def standing(observations: Iterable[Observation]) -> Blocks:
    """The blocks that stand after all observations."""
    return reduce(blocks_after, observations, ())


def history_of(observations: Iterable[Observation]) -> Iterator[Blocks]:
    """The blocks that stand after each observation."""
    blocks: Blocks = ()
    for observation in observations:
        blocks = blocks_after(blocks, observation)
        yield blocks


def mask_of(board: Board, blocks: Iterable[Placed]) -> Mask:
    """The cells that blocks fill."""
    mask = 0
    for placed in blocks:
        mask |= rules.cells_of(board, placed)
    return mask


def states_of(board: Board, observations: Iterable[Observation]) -> list[Mask]:
    """The filled cells after each observation; list index is the sequence."""
    states: list[Mask] = []
    blocks: Blocks = ()
    built = 0
    for observation in observations:
        blocks = blocks_after(blocks, observation)
        if observation.gone:
            built = mask_of(board, blocks)
        else:
            built |= mask_of(board, observation.landed)
        states.append(built)
    return states


def impossible(board: Board, blocks: Blocks) -> str:
    """Why blocks cannot stand on a board in these places; '' if they can.

    Each lies inside, none overlaps another, and each rests on the ground or on a block.
    """
    filled = 0
    for placed in blocks:
        if not rules.is_inside(board, placed):
            return f'block {shown_block(placed)} does not lie inside the board'
        cells = rules.cells_of(board, placed)
        if cells & filled:
            return f'block {shown_block(placed)} overlaps another block'
        filled |= cells
    for placed in blocks:
        if placed.row and not rules.cells_of(board, below(placed)) & filled:
            return f'block {shown_block(placed)} rests on nothing'
    return ''


def below(placed: Placed) -> Placed:
    """The row of cells just below a block that is not on the ground."""
    return Placed(placed.width, 1, placed.column, placed.row - 1)


def wrong_change(blocks: Blocks, observation: Observation) -> str:
    """Why an observation contradicts the blocks that stood before; '' if it does not."""
    missing = [placed for placed in observation.gone if placed not in blocks]
    if missing:
        return f'block {shown_block(missing[0])} is gone, but it was not on the board'
    return ''


def shown_block(placed: Placed) -> str:
    """A placed block in an error message."""
    return f'{placed.width}x{placed.height} in column {placed.column} and row {placed.row}'
