"""Contacts of blocks, and tests of stability without a linear program.

Blocks touch where one lies on another or on the ground, over an interval of columns. Sides do not
count. See :mod:`.statics` for the forces there.
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import NamedTuple, TypeVar

from blocks_planning.board.blocks import Placed

Number = TypeVar('Number', float, Fraction)


class Contact(NamedTuple):
    """An interval in which a block rests on another.

    ``upper`` and ``lower`` are numbers of blocks, ``lower`` None for the ground; ``left`` and
    ``right`` are the ends [cells].
    """

    upper: int
    lower: int | None
    left: int
    right: int


class Structure(NamedTuple):
    """Blocks from the highest row to the lowest, and the contacts below each."""

    blocks: tuple[Placed, ...]
    below: tuple[tuple[Contact, ...], ...]


def structure_of(blocks: Iterable[Placed]) -> Structure:
    """The contacts of blocks that do not overlap."""
    ordered = tuple(sorted(blocks, key=lambda block: (-block.row, block.column)))
    below = tuple(
        tuple(_contacts_below(ordered, number, block)) for number, block in enumerate(ordered)
    )
    return Structure(ordered, below)


def _contacts_below(blocks: tuple[Placed, ...], upper: int, block: Placed) -> Iterable[Contact]:
    end = block.column + block.width
    if block.row == 0:
        yield Contact(upper, None, block.column, end)
    for lower, other in enumerate(blocks):
        left, right = max(block.column, other.column), min(end, other.column + other.width)
        if other.row + other.height == block.row and left < right:
            yield Contact(upper, lower, left, right)


def is_carried(structure: Structure, margin: Number) -> bool:
    """Whether passing weights straight down, without friction, balances every block.

    The weight of a block and of all that it carries goes to the one contact below its resultant,
    or to the nearest ends of two contacts on either side. If that works for every block, it is a
    solution of the equations of :mod:`.statics`; if not, there may be another one.

    Args:
        structure: the blocks.
        margin: how far ends of contacts are moved inwards [cells]; its type is that of the
            computation.
    """
    number = type(margin)
    loads: list[list[tuple[Number, Number]]] = [[] for _ in structure.blocks]
    for index, block in enumerate(structure.blocks):
        area = block.width * block.height
        weight, moment = number(area), number(area * (2 * block.column + block.width)) / 2
        for place, load in loads[index]:
            weight += load
            moment += load * place
        shares = _shares(structure.below[index], moment / weight, weight, margin)
        if not shares:
            return False
        for contact, place, load in shares:
            if contact.lower is not None:
                loads[contact.lower].append((place, load))
    return True


def _shares(
    contacts: tuple[Contact, ...], place: Number, weight: Number, margin: Number
) -> list[tuple[Contact, Number, Number]]:
    """How contacts carry a weight: contact, position and load of each; none if they can't."""
    for contact in contacts:
        if contact.left + margin <= place <= contact.right - margin:
            return [(contact, place, weight)]
    before = [contact for contact in contacts if contact.right - margin < place]
    after = [contact for contact in contacts if contact.left + margin > place]
    if not before or not after:
        return []
    left = max(before, key=lambda contact: contact.right)
    right = min(after, key=lambda contact: contact.left)
    first, last = left.right - margin, right.left + margin
    share = (place - first) / (last - first) * weight
    return [(left, first, weight - share), (right, last, share)]


def must_tip(structure: Structure, margin: Fraction) -> bool:
    """Whether the weight of some block, with everything on it, lies beyond its support.

    Only blocks whose load rests on nothing else are tested. For them, all outer forces except
    weights act at one height, so friction has no moment, and the centre of mass must be between the
    outermost ends of the contacts.

    Args:
        structure: the blocks.
        margin: how far ends of contacts are moved inwards [cells].
    """
    above = _above(structure)
    for index, contacts in enumerate(structure.below):
        body = above[index]
        others = (
            contact.lower
            for member in body
            if member != index
            for contact in structure.below[member]
        )
        if any(lower is None or lower not in body for lower in others):
            continue
        if not contacts:
            return True
        blocks = [structure.blocks[member] for member in body]
        weight = sum(block.width * block.height for block in blocks)
        moment = sum(
            block.width * block.height * (2 * block.column + block.width) for block in blocks
        )
        centre = Fraction(moment, 2 * weight)
        left = min(contact.left for contact in contacts) + margin
        right = max(contact.right for contact in contacts) - margin
        if not left <= centre <= right:
            return True
    return False


def _above(structure: Structure) -> list[set[int]]:
    """For every block, itself and all blocks that rest on it, directly or indirectly."""
    above = [{index} for index in range(len(structure.blocks))]
    for index, contacts in enumerate(structure.below):  # from the highest row down
        for contact in contacts:
            if contact.lower is not None:
                above[contact.lower] |= above[index]
    return above
