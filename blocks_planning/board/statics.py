"""Stability of towers of loose blocks.

At both ends of every contact (:mod:`.contacts`) a force N >= 0 acts upwards on the upper block,
and a friction T, -mu N <= T <= mu N, along the contact; the opposite forces act on the lower block.
For every block the sums of T, of N against its weight (its area), and of moments are 0. If these
equations have no solution, the tower must fall. If they have one only with the true ends of the
contacts, and none with the ends moved inwards by :data:`MARGIN`, the tower is on the edge.

Most towers are decided without a linear program: :func:`.contacts.is_carried` finds a solution, or
:func:`.contacts.must_tip` shows that there is none. The rest is decided by the HiGHS solver of
scipy. Answers are cached by the set of blocks.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from fractions import Fraction
from functools import lru_cache

from blocks_planning.board.blocks import Placed
from blocks_planning.board.contacts import Contact, Structure, is_carried, must_tip, structure_of
from blocks_planning.errors import BlocksPlanningError, ConfigurationError
from blocks_planning.extras import extra

MARGIN = Fraction(1, 50)
"""How far the ends of contacts are moved inwards for a tower that stands [cells]."""
FRICTION = 0.5
"""Coefficient of friction, mu. On towers that people built, 0.3 to 1.4 give the same answers."""
REMEMBERED = 1 << 16
"""Largest number of towers whose answers are cached."""

_ROUNDING = 1e-9
_NO_MARGIN = Fraction(0)


class Stability(str, Enum):
    """The stability of a tower of loose blocks."""

    STANDS = 'stands'
    EDGE = 'edge'
    FALLS = 'falls'


def stability(blocks: Iterable[Placed], friction: float = FRICTION) -> Stability:
    """Whether a tower stands, is on the edge, or falls.

    Args:
        blocks: all blocks of the tower, in any order. They must not overlap; row 0 is the ground.
            A block that rests on nothing falls.
        friction: coefficient mu, above 0.

    Raises:
        ConfigurationError: if a linear program is needed and scipy is not installed.
        BlocksPlanningError: if the solver fails, which indicates a defect.
    """
    return _remembered(frozenset(blocks), friction)


def holds(blocks: Iterable[Placed], edge_stands: bool = True, friction: float = FRICTION) -> bool:
    """Whether a tower is stable; ``edge_stands`` decides for towers on the edge."""
    found = stability(blocks, friction)
    return found is Stability.STANDS or (edge_stands and found is Stability.EDGE)


@lru_cache(maxsize=REMEMBERED)
def _remembered(blocks: frozenset[Placed], friction: float) -> Stability:
    structure = structure_of(blocks)
    known = decide_fast(structure)
    return decide_by_program(structure, friction) if known is None else known


def decide_fast(structure: Structure) -> Stability | None:
    """The stability of a tower without a linear program; None if that is not decisive."""
    # Rounding can't create a solution: the ends are moved by more than the rounding error.
    if is_carried(structure, float(MARGIN) + _ROUNDING):
        return Stability.STANDS
    if must_tip(structure, _NO_MARGIN):
        return Stability.FALLS
    if must_tip(structure, MARGIN) and is_carried(structure, _NO_MARGIN):
        return Stability.EDGE
    return None


def decide_by_program(structure: Structure, friction: float) -> Stability:
    """The same as :func:`stability` by linear programs alone."""
    if _is_solvable(structure, friction, float(MARGIN)):
        return Stability.STANDS
    return Stability.EDGE if _is_solvable(structure, friction, 0.0) else Stability.FALLS


def _is_solvable(structure: Structure, friction: float, margin: float) -> bool:
    """Whether forces balance every block.

    The unknowns are the parts of each end's force along the two borders of its cone of friction:
    (mu, 1) and (-mu, 1), each 0 or more. So only equations are left.
    """
    try:
        with extra('experiments'):
            from scipy.optimize import linprog
            from scipy.sparse import csr_array
    except ImportError:
        raise ConfigurationError(
            'loose blocks need scipy to decide whether a tower stands: install scipy, or the '
            'package with its extra "experiments"'
        ) from None
    if not structure.blocks:
        return True
    contacts = [contact for below in structure.below for contact in below]
    entries = [
        entry
        for number, contact in enumerate(contacts)
        for entry in _entries(structure, contact, 4 * number, friction, margin)
    ]
    rows, columns, values = zip(*entries, strict=True) if entries else ((), (), ())
    shape = (3 * len(structure.blocks), max(1, 4 * len(contacts)))
    wanted = [
        part
        for block in structure.blocks
        for area in (block.width * block.height,)
        for part in (0.0, area, area * (block.column + block.width / 2))
    ]
    found = linprog(
        c=[0.0] * shape[1],
        A_eq=csr_array((values, (rows, columns)), shape=shape),
        b_eq=wanted,
        method='highs',
    )
    if found.status not in (0, 2):  # solved, infeasible
        raise BlocksPlanningError(f'the linear program of a tower ended with: {found.message}')
    return bool(found.status == 0)


def _entries(
    structure: Structure, contact: Contact, first: int, friction: float, margin: float
) -> Iterable[tuple[int, int, float]]:
    """The coefficients of a contact's four unknowns: row, column, value of each.

    Rows 3 i, 3 i + 1 and 3 i + 2 are the sums for block i along the ground, upwards, and of
    moments about the origin.
    """
    height = structure.blocks[contact.upper].row
    ends = (contact.left + margin, contact.right - margin)
    sides = [(contact.upper, 1.0)]
    if contact.lower is not None:
        sides.append((contact.lower, -1.0))
    for number, (place, along) in enumerate(
        (end, mu) for end in ends for mu in (friction, -friction)
    ):
        for block, sign in sides:
            yield 3 * block, first + number, sign * along
            yield 3 * block + 1, first + number, sign
            yield 3 * block + 2, first + number, sign * (place - along * height)
