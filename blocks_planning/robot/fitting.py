"""Fits perceived blocks to a possible state: blocks on cells, without overlap, all supported.

A block gets the rectangle of cells that it covers most. If a rectangle would overlap another one,
or have no support, the next best is used; a block without a possible rectangle is omitted, and the
state is then impossible.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.robot.coverage import Coverage, Sighting

LEAST_SHARE = 0.5
"""Least share of the area of a block that must be in its cells."""


class Misfit(str, Enum):
    """Kinds of deviations from the grid."""

    DISPLACED = 'displaced'
    TILTED = 'tilted'
    CORRECTED = 'corrected'
    OFF_BOARD = 'off_board'
    IMPOSSIBLE = 'impossible'


@dataclass(frozen=True)
class Remark:
    """A deviation from the grid.

    Attributes:
        kind: kind of the deviation.
        number: of the block.
        text: a sentence about it.
    """

    kind: Misfit
    number: int
    text: str


@dataclass(frozen=True)
class Perceived:
    """The perceived state of the board.

    Attributes:
        blocks: every block on the board with its number, in the order of the numbers.
        warnings: deviations from the grid.
    """

    blocks: tuple[tuple[int, Placed], ...] = ()
    warnings: tuple[Remark, ...] = ()

    @property
    def placed(self) -> tuple[Placed, ...]:
        """Every block on the board."""
        return tuple(placed for _, placed in self.blocks)

    @property
    def is_possible(self) -> bool:
        """Whether every block on the board has cells."""
        return all(warning.kind is not Misfit.IMPOSSIBLE for warning in self.warnings)

    def built(self, board: Board) -> Mask:
        """The filled cells."""
        filled = 0
        for placed in self.placed:
            filled |= rules.cells_of(board, placed)
        return filled


@dataclass(frozen=True)
class Change:
    """The differences between two states; blocks that moved are in both lists."""

    landed: tuple[Placed, ...]
    gone: tuple[Placed, ...]


def change(before: Perceived, after: Perceived) -> Change:
    """The blocks that landed and those that are gone, in the order of the numbers."""
    old, new = dict(before.blocks), dict(after.blocks)
    return Change(
        tuple(placed for number, placed in after.blocks if old.get(number) != placed),
        tuple(placed for number, placed in before.blocks if new.get(number) != placed),
    )


def fit(board: Board, sightings: Iterable[Sighting], tolerance: float) -> Perceived:
    """The possible state that fits the sightings best.

    Args:
        board: its size.
        sightings: of every block except the one that the arm holds.
        tolerance: share of a cell by which a block may deviate without a warning.
    """
    found: list[tuple[int, Placed]] = []
    warnings: list[Remark] = []
    built = 0
    for sighting in sorted(sightings, key=_height):
        if _is_off(board, sighting):
            warnings.append(_remark(Misfit.OFF_BOARD, sighting, 'is not on the board'))
            continue
        choices = sorted(_choices(board, sighting), key=lambda choice: -choice[0])
        best = next((one for one in choices if _is_possible(board, built, one[1])), None)
        if best is None:
            warnings.append(_remark(Misfit.IMPOSSIBLE, sighting, 'is in an impossible place'))
            continue
        share, placed = best
        built |= rules.cells_of(board, placed)
        found.append((sighting.number, placed))
        kind, text = _judge(sighting, placed, tolerance, share < choices[0][0])
        if kind is not None:
            warnings.append(_remark(kind, sighting, text))
    return Perceived(tuple(sorted(found)), tuple(sorted(warnings, key=lambda one: one.number)))


def _remark(kind: Misfit, sighting: Sighting, text: str) -> Remark:
    return Remark(kind, sighting.number, f'block {sighting.block} {text}')


def _height(sighting: Sighting) -> tuple[float, int]:
    """Sort key: lower blocks come first."""
    total = sum(sighting.coverage.values())
    weighted = sum(row * share for (_, row), share in sighting.coverage.items())
    return (weighted / total if total else 0.0, sighting.number)


def _is_off(board: Board, sighting: Sighting) -> bool:
    """Whether less than half of a block is over the board."""
    inside = sum(
        share
        for (column, row), share in sighting.coverage.items()
        if 0 <= column < board.width and 0 <= row < board.height
    )
    return sighting.is_off_plane or inside < LEAST_SHARE * sighting.block.area


def _choices(board: Board, sighting: Sighting) -> Iterator[tuple[float, Placed]]:
    """Rectangles of cells with at least half of a block, upright or lying, ordered by share."""
    coverage = sighting.coverage
    columns = [column for column, _ in coverage]
    rows = [row for _, row in coverage]
    width, height = sighting.block
    for across, up in dict.fromkeys([(width, height), (height, width)]):
        for column in range(min(columns) - 1, max(columns) + 2):
            for row in range(min(rows) - 1, max(rows) + 2):
                placed = Placed(across, up, column, row)
                share = _share(coverage, placed)
                if share >= LEAST_SHARE and _is_inside(board, placed):
                    yield share, placed


def _share(coverage: Coverage, placed: Placed) -> float:
    covered = sum(coverage.get(cell, 0.0) for cell in _cells(placed))
    return covered / (placed.width * placed.height)


def _cells(placed: Placed) -> Iterator[tuple[int, int]]:
    for column in range(placed.column, placed.column + placed.width):
        for row in range(placed.row, placed.row + placed.height):
            yield column, row


def _is_inside(board: Board, placed: Placed) -> bool:
    return (
        placed.column >= 0
        and placed.row >= 0
        and placed.column + placed.width <= board.width
        and placed.row + placed.height <= board.height
    )


def _is_possible(board: Board, built: Mask, placed: Placed) -> bool:
    """Whether a block overlaps no other block and rests on one or on the ground."""
    cells = rules.cells_of(board, placed)
    if cells & built:
        return False
    below = Placed(placed.width, 1, placed.column, placed.row - 1)
    return placed.row == 0 or bool(rules.cells_of(board, below) & built)


def _judge(
    sighting: Sighting, placed: Placed, tolerance: float, is_corrected: bool
) -> tuple[Misfit | None, str]:
    """The deviation of a block that has cells; None if there is none."""
    inside = set(_cells(placed))
    missing = max(1 - sighting.coverage.get(cell, 0.0) for cell in inside)
    beyond = max((v for cell, v in sighting.coverage.items() if cell not in inside), default=0.0)
    where = f'column {placed.column}, row {placed.row}'
    if is_corrected:
        return Misfit.CORRECTED, f'is only possible in {where}'
    if sighting.tilt is not None and sighting.tilt > MOST_TILT:
        return Misfit.TILTED, f'in {where} is tilted by {sighting.tilt:.0f} degrees'
    if max(missing, beyond) > tolerance:
        return (
            Misfit.DISPLACED,
            f'in {where} deviates from its cells by {max(missing, beyond):.2f} cell',
        )
    return None, ''


MOST_TILT = 3.0
"""Largest tilt of a block without a warning [degrees]."""
