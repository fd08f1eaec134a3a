"""Whether loose blocks stand: the equations of statics, solved in exact fractions.

Contacts are read off cells: where the columns under a block's bottom row belong to another block,
or the block is on the ground. The unknowns of an end of a contact are N, T to the right and T to
the left; that they stay in the cone of friction is an inequality of its own. Whether a solution
exists is found by the simplex method (phase 1, Bland's rule), which always ends.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from oracles.board import Placement, cells_of

STANDS, EDGE, FALLS = 'stands', 'edge', 'falls'

End = tuple[int, int | None, Fraction, int]  # upper block, lower block, place, height
Row = list[Fraction]


def stability(blocks: Sequence[Placement], friction: Fraction, margin: Fraction) -> str:
    """STANDS if solvable with ends moved inwards, EDGE if only with the true ends, else FALLS."""
    if is_solvable(*equations(blocks, friction, margin)):
        return STANDS
    return EDGE if is_solvable(*equations(blocks, friction, Fraction(0))) else FALLS


def ends_of_contacts(blocks: Sequence[Placement], margin: Fraction) -> list[End]:
    """Every end of every contact."""
    owner = {cell: number for number, block in enumerate(blocks) for cell in cells_of(block)}
    ends: list[End] = []
    for number, block in enumerate(blocks):
        touched: dict[int | None, list[int]] = {}
        for column in range(block.column, block.column + block.width):
            if block.row == 0:
                touched.setdefault(None, []).append(column)
            elif (column, block.row - 1) in owner:
                touched.setdefault(owner[column, block.row - 1], []).append(column)
        for other, columns in touched.items():
            ends.append((number, other, min(columns) + margin, block.row))
            ends.append((number, other, max(columns) + 1 - margin, block.row))
    return ends


def equations(
    blocks: Sequence[Placement], friction: Fraction, margin: Fraction
) -> tuple[list[Row], Row]:
    """A and b of A x = b, x >= 0: three equations for each block and one for each end."""
    ends = ends_of_contacts(blocks, margin)
    rows = [[Fraction(0)] * (4 * len(ends)) for _ in range(3 * len(blocks) + len(ends))]
    right = [Fraction(0)] * len(rows)
    for number, block in enumerate(blocks):
        weight = Fraction(block.width * block.height)
        right[3 * number] = weight
        right[3 * number + 1] = weight * (block.column + Fraction(block.width, 2))
    for index, (upper, lower, place, height) in enumerate(ends):
        for block_number, sign in ((upper, 1), (lower, -1)):
            if block_number is None:
                continue
            upwards, moment, along = rows[3 * block_number : 3 * block_number + 3]
            upwards[4 * index] += sign
            moment[4 * index] += sign * place
            for part, direction in ((1, 1), (2, -1)):  # T to the right, T to the left
                along[4 * index + part] += sign * direction
                moment[4 * index + part] -= sign * direction * height
        cone = rows[3 * len(blocks) + index]
        cone[4 * index : 4 * index + 4] = [friction, Fraction(-1), Fraction(-1), Fraction(-1)]
    return rows, right


def is_solvable(rows: list[Row], right: Row) -> bool:
    """Whether A x = b has a solution with x >= 0; b >= 0."""
    variables = len(rows[0]) if rows else 0
    table = [
        [*row, *(Fraction(int(other == number)) for other in range(len(rows))), right[number]]
        for number, row in enumerate(rows)
    ]
    basis = [variables + number for number in range(len(rows))]
    cost = [-sum((row[column] for row in table), Fraction(0)) for column in range(variables)]
    left = sum(right, Fraction(0))  # the sum of the artificial variables, to be made 0
    while left > 0:
        entering = next((column for column in range(variables) if cost[column] < 0), None)
        if entering is None:
            return False
        leaving = min(
            (number for number, row in enumerate(table) if row[entering] > 0),
            key=lambda number: (table[number][-1] / table[number][entering], basis[number]),
        )
        pivot(table, leaving, entering)
        basis[leaving] = entering
        factor = cost[entering]
        cost = [value - factor * table[leaving][column] for column, value in enumerate(cost)]
        left += factor * table[leaving][-1]
    return True


def pivot(table: list[Row], leaving: int, entering: int) -> None:
    """Solve row ``leaving`` for column ``entering``, and put it into the other rows."""
    divisor = table[leaving][entering]
    table[leaving] = [value / divisor for value in table[leaving]]
    for number, row in enumerate(table):
        if number != leaving and row[entering]:
            factor = row[entering]
            table[number] = [
                value - factor * other for value, other in zip(row, table[leaving], strict=True)
            ]
