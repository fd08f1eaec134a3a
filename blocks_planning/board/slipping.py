"""Where a block comes to rest in a world that loses and slips blocks.

With probability ``loss`` an order leaves the board as it is. Else, with probability ``slip``, the
block lands one column left or right of the order, each with half of that; where it cannot land
there, it lands as ordered. Only :func:`landings` defines the
distribution of outcomes; draws sample from it, and exact values are sums over it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed, Placement
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.errors import ConfigurationError, InvalidInput, shown

DRAW_STEPS = 1 << 53
"""Number of equal steps from 0 to 1 over which a draw is uniform: the precision of a float64."""


class Landing(NamedTuple):
    """One outcome of an order: its probability, and where the block rests (None: lost)."""

    probability: float
    placed: Placed | None


def landings(
    board: Board, built: Mask, placement: Placement, slip: float, loss: float = 0.0
) -> tuple[Landing, ...]:
    """Every outcome of an order with a probability above 0: lost, left, right, as ordered.

    Args:
        board: size of the board.
        built: filled cells.
        placement: the order; it must be possible.
        slip: probability p that a block that is not lost lands one column off.
        loss: probability q that the order leaves the board as it is.

    Returns:
        Outcomes whose probabilities sum to 1 except for rounding.

    Raises:
        InvalidInput: if the order is not possible.
        ConfigurationError: if a probability is not from 0 to 1.
    """
    check_probability('slip', slip)
    check_probability('loss', loss)
    ordered = rules.drop(board, built, placement)
    if ordered is None:
        raise InvalidInput(
            f'order {placement.block} at column {placement.column} is not possible: the block '
            f'would leave the board of {board.width} x {board.height} cells'
        )
    found = [Landing(loss, None)]
    as_ordered = 1.0 - slip
    for column in (placement.column - 1, placement.column + 1):
        placed = rules.drop(board, built, Placement(placement.block, column))
        if placed is None:
            as_ordered += slip / 2
        else:
            found.append(Landing((1.0 - loss) * (slip / 2), placed))
    found.append(Landing((1.0 - loss) * as_ordered, ordered))
    return tuple(landing for landing in found if landing.probability > 0)


def pick(outcomes: tuple[Landing, ...], below: Callable[[int], int]) -> Landing:
    """Draw one outcome with the probabilities of :func:`landings`.

    Args:
        outcomes: what :func:`landings` returned.
        below: gives a uniform whole number from 0 to its argument - 1, such as
            ``Generator.below``; called once.
    """
    drawn = below(DRAW_STEPS)
    reached = 0.0
    for landing in outcomes[:-1]:
        reached += landing.probability
        if drawn < reached * DRAW_STEPS:
            return landing
    return outcomes[-1]


def check_probability(name: str, value: object) -> None:
    """Refuse a value that is not a probability.

    Raises:
        ConfigurationError: naming the value.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value <= 1:
        raise ConfigurationError(f'{name} must be a number from 0 to 1, got {shown(value)}')
