"""The generator that breaks ties; its seed depends only on the question.

Attempt ``a`` of filling a region from a state under trial seed ``s`` draws from a generator seeded
with (s, state, region, a); a tie between subgoals from (s, state). So a solve is a pure
function of its arguments, on every machine and with every version of numpy (numpy's own streams
can change between versions).

The generator is SplitMix64 (Steele, Lea and Flood, 2014). Its key starts at 0 and absorbs one
64-bit word after the other, ``key = mix((key ^ word) + GAMMA)``; a draw adds GAMMA to the key
and mixes. Masks are absorbed as four little-endian words. The compiled twin is in
:mod:`.kernels.randomness`.
"""

from __future__ import annotations

from collections.abc import Iterable

from blocks_planning.board.geometry import Mask

GAMMA = 0x9E3779B97F4A7C15
MIX_1 = 0xBF58476D1CE4E5B9
MIX_2 = 0x94D049BB133111EB
MASK_WORDS = 4
MAX_SEED = (1 << 64) - 1
_WORD = (1 << 64) - 1


def mix(word: int) -> int:
    """Scramble a 64-bit word (a bijection)."""
    word = (word ^ word >> 30) * MIX_1 & _WORD
    word = (word ^ word >> 27) * MIX_2 & _WORD
    return word ^ word >> 31


def mask_words(mask: Mask) -> list[int]:
    """The four 64-bit words of a mask, lowest first."""
    return [mask >> 64 * index & _WORD for index in range(MASK_WORDS)]


class Generator:
    """A stream of uniform whole numbers.

    >>> Generator([7, *mask_words(0b1011)]).below(100)
    57
    """

    def __init__(self, words: Iterable[int]) -> None:
        """Seed the generator with some 64-bit words; their number matters too."""
        self._key = 0
        for word in words:
            self._key = mix((self._key ^ word) + GAMMA & _WORD)

    def _next(self) -> int:
        self._key = self._key + GAMMA & _WORD
        return mix(self._key)

    def below(self, bound: int) -> int:
        """A number from 0 to ``bound - 1``, each equally likely; 1 <= bound < 2**64."""
        limit = (1 << 64) - (1 << 64) % bound
        while (draw := self._next()) >= limit:
            pass
        return draw % bound
