"""Compiled twin of :mod:`blocks_planning.search.randomness`. A generator is uint64 (1,)."""

from __future__ import annotations

import numpy as np

from blocks_planning.board.kernels.compiling import inlined
from blocks_planning.search import randomness

_GAMMA = np.uint64(randomness.GAMMA)
_MIX_1 = np.uint64(randomness.MIX_1)
_MIX_2 = np.uint64(randomness.MIX_2)
_27, _30, _31 = np.uint64(27), np.uint64(30), np.uint64(31)
_ZERO = np.uint64(0)


@inlined
def mix(word):
    """Scramble a uint64."""
    word = (word ^ (word >> _30)) * _MIX_1
    word = (word ^ (word >> _27)) * _MIX_2
    return word ^ (word >> _31)


@inlined
def key_of(words):
    """The key of the attempts at a problem from its uint64 ``words`` (n,)."""
    key = _ZERO
    for word in words:
        key = mix((key ^ word) + _GAMMA)
    return key


@inlined
def seed(generator, key, attempt):
    """Seed the generator of an attempt with the key of its problem, then its number."""
    generator[0] = mix((key ^ np.uint64(attempt)) + _GAMMA)


@inlined
def below(generator, bound):
    """A number from 0 to ``bound - 1``, each equally likely, int64; bound is int64, positive."""
    size = np.uint64(bound)
    while True:
        key = generator[0] + _GAMMA
        generator[0] = key
        draw = mix(key)
        # A draw is taken below the largest multiple of ``size``, which is 2**64 - rest. Nearly all
        # are at least ``size`` below 2**64 and need no rest: a division takes long.
        if draw < _ZERO - size or draw <= ~((_ZERO - size) % size):
            return np.int64(draw % size)
