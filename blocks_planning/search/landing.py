"""The outcome of an order in a random world: a pure function of seed and sequence."""

from __future__ import annotations

from blocks_planning.board.blocks import Placement
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.slipping import Landing, landings, pick
from blocks_planning.search.randomness import Generator

WORLD = int.from_bytes(b'world', 'little')
"""A constant that separates the generator of a world from those of planners."""


def draw_landing(
    board: Board,
    built: Mask,
    placement: Placement,
    slip: float,
    loss: float,
    seed: int,
    sequence: int,
) -> Landing:
    """Draw the outcome of an order, from a generator made of (seed, sequence, a constant).

    The outcome is the same after a restart, in any process and in any order of calls.

    Args:
        board: size of the board.
        built: filled cells when the order is carried out.
        placement: the order; it must be possible.
        slip: probability p that a block that is not lost lands one column off.
        loss: probability q that the order leaves the board as it is.
        seed: of the trial, 0 to 2**64 - 1.
        sequence: number of the observation that the order makes, 1 or more.

    Returns:
        The outcome with its probability; ``placed`` is None if the order was lost.

    Raises:
        InvalidInput: if the order is not possible.
        ConfigurationError: if a probability is not from 0 to 1.
    """
    outcomes = landings(board, built, placement, slip, loss)
    return pick(outcomes, Generator([seed, sequence, WORLD]).below)
