"""The masks that every kernel works on.

A kernel mask is one ``uint64`` on boards of up to 64 cells and a tuple of four on larger ones. ``&
| ~ << >>``, :func:`count`, :func:`lowest`, :func:`without_lowest`, :func:`is_empty`,
:func:`digest`, :func:`load`, :func:`store` and :func:`add_bit` mean the same for both, so a kernel
is written once and compiled for each. Shift distances are ``uint64`` from 1 to 63.
"""

from __future__ import annotations

import operator

import numpy as np
from numba import types
from numba.extending import intrinsic, overload

from blocks_planning.board.geometry import Mask
from blocks_planning.board.kernels.compiling import inlined

WORD_BITS = 64
WIDE_WORDS = 4
_WORD = (1 << WORD_BITS) - 1
_ZERO, _ONE, _SIXTY_FOUR = np.uint64(0), np.uint64(1), np.uint64(WORD_BITS)


def _is_wide(mask: types.Type) -> bool:
    return isinstance(mask, types.UniTuple) and mask.count == WIDE_WORDS


@overload(operator.and_)
def _and(a, b):
    if _is_wide(a) and _is_wide(b):
        return lambda a, b: (a[0] & b[0], a[1] & b[1], a[2] & b[2], a[3] & b[3])
    return None


@overload(operator.or_)
def _or(a, b):
    if _is_wide(a) and _is_wide(b):
        return lambda a, b: (a[0] | b[0], a[1] | b[1], a[2] | b[2], a[3] | b[3])
    return None


@overload(operator.invert)
def _invert(a):
    if _is_wide(a):
        return lambda a: (~a[0], ~a[1], ~a[2], ~a[3])
    return None


@overload(operator.rshift)
def _rshift(a, k):
    if _is_wide(a):

        def shift(a, k):
            back = _SIXTY_FOUR - k
            return (
                a[0] >> k | a[1] << back,
                a[1] >> k | a[2] << back,
                a[2] >> k | a[3] << back,
                a[3] >> k,
            )

        return shift
    return None


@overload(operator.lshift)
def _lshift(a, k):
    if _is_wide(a):

        def shift(a, k):
            back = _SIXTY_FOUR - k
            return (
                a[0] << k,
                a[1] << k | a[0] >> back,
                a[2] << k | a[1] >> back,
                a[3] << k | a[2] >> back,
            )

        return shift
    return None


@intrinsic
def _popcount(_typing, word):
    def code(_context, builder, _signature, arguments):
        return builder.ctpop(arguments[0])

    return types.uint64(types.uint64), code


@intrinsic
def _trailing_zeros(_typing, word):
    def code(_context, builder, _signature, arguments):
        undefined_for_zero = arguments[0].type.__class__(1)(1)
        return builder.cttz(arguments[0], undefined_for_zero)

    return types.uint64(types.uint64), code


@inlined
def _mix(word):
    word = (word ^ (word >> np.uint64(32))) * np.uint64(0x9FB21C651E98DF25)
    return word ^ (word >> np.uint64(32))


def is_empty(mask):
    """Whether a mask has no cell."""


def count(mask):
    """Number of cells of a mask, int64."""


def lowest(mask):
    """Index of the lowest bit of a mask that is not empty, int64."""


def without_lowest(mask):
    """The mask, not empty, without its lowest bit."""


def load(table, index):
    """Mask number ``index`` of a table: uint64 (n,), or (n, 4) on a wide board."""


def store(table, index, mask):
    """Write mask number ``index`` of a table."""


def add_bit(table, index, bit):
    """Set a bit of mask number ``index`` of a table."""


def digest(mask):
    """A hash of a mask, uint64."""


@overload(is_empty)
def _is_empty(mask):
    if _is_wide(mask):
        return lambda mask: (mask[0] | mask[1] | mask[2] | mask[3]) == _ZERO
    return lambda mask: mask == _ZERO


@overload(count)
def _count(mask):
    if _is_wide(mask):
        return lambda mask: np.int64(
            _popcount(mask[0]) + _popcount(mask[1]) + _popcount(mask[2]) + _popcount(mask[3])
        )
    return lambda mask: np.int64(_popcount(mask))


@overload(lowest)
def _lowest(mask):
    if _is_wide(mask):

        def find(mask):
            if mask[0] != _ZERO:
                return np.int64(_trailing_zeros(mask[0]))
            if mask[1] != _ZERO:
                return np.int64(_trailing_zeros(mask[1])) + WORD_BITS
            if mask[2] != _ZERO:
                return np.int64(_trailing_zeros(mask[2])) + 2 * WORD_BITS
            return np.int64(_trailing_zeros(mask[3])) + 3 * WORD_BITS

        return find
    return lambda mask: np.int64(_trailing_zeros(mask))


@overload(without_lowest)
def _without_lowest(mask):
    if _is_wide(mask):

        def clear(mask):
            if mask[0] != _ZERO:
                return (mask[0] & (mask[0] - _ONE), mask[1], mask[2], mask[3])
            if mask[1] != _ZERO:
                return (mask[0], mask[1] & (mask[1] - _ONE), mask[2], mask[3])
            if mask[2] != _ZERO:
                return (mask[0], mask[1], mask[2] & (mask[2] - _ONE), mask[3])
            return (mask[0], mask[1], mask[2], mask[3] & (mask[3] - _ONE))

        return clear
    return lambda mask: mask & (mask - _ONE)


@overload(load)
def _load(table, index):
    if table.ndim == 1:
        return lambda table, index: table[index]
    return lambda table, index: (
        table[index, 0],
        table[index, 1],
        table[index, 2],
        table[index, 3],
    )


@overload(store)
def _store(table, index, mask):
    if table.ndim == 1:

        def write(table, index, mask):
            table[index] = mask
    else:

        def write(table, index, mask):
            table[index, 0] = mask[0]
            table[index, 1] = mask[1]
            table[index, 2] = mask[2]
            table[index, 3] = mask[3]

    return write


@overload(add_bit)
def _add_bit(table, index, bit):
    if table.ndim == 1:

        def set_bit(table, index, bit):
            table[index] |= _ONE << np.uint64(bit)
    else:

        def set_bit(table, index, bit):
            table[index, bit // WORD_BITS] |= _ONE << np.uint64(bit % WORD_BITS)

    return set_bit


@overload(digest)
def _digest(mask):
    if _is_wide(mask):
        return lambda mask: _mix(_mix(_mix(_mix(mask[0]) ^ mask[1]) ^ mask[2]) ^ mask[3])
    return lambda mask: _mix(mask)  # noqa: PLW0108  numba compares the signatures


def pack(masks: list[Mask], cells: int) -> np.ndarray:
    """A table of masks of a board with ``cells`` cells: uint64 (n,), or (n, 4) above 64 cells."""
    words = words_of(masks)
    return np.ascontiguousarray(words[:, 0]) if cells <= WORD_BITS else words


def words_of(masks: list[Mask]) -> np.ndarray:
    """Masks as four little-endian words each: uint64 (n, 4)."""
    return np.array(
        [[mask >> WORD_BITS * word & _WORD for word in range(WIDE_WORDS)] for mask in masks],
        dtype=np.uint64,
    ).reshape(len(masks), WIDE_WORDS)
