"""The generator every draw comes from: SplitMix64, and how it is seeded.

A mask appears here only, and only as seed material: it is the integer with bit
``column * height + row`` set for each cell.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

WORD_RANGE = 2**64
GAMMA = 0x9E3779B97F4A7C15
WORDS_PER_MASK = 4


def mix64(z: int) -> int:
    """The output function of SplitMix64."""
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9 % WORD_RANGE
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB % WORD_RANGE
    return z ^ (z >> 31)


def key_from_words(words: Sequence[int]) -> int:
    """The starting key made of 64-bit words.

    Raises ValueError when a word does not fit into 64 bits.
    """
    key = 0
    for word in words:
        if not 0 <= word < WORD_RANGE:
            raise ValueError(f'a seed word must be in 0..2**64 - 1, got {word}')
        key = mix64(((key ^ word) + GAMMA) % WORD_RANGE)
    return key


def mask_of(cells: Iterable[tuple[int, int]], height: int) -> int:
    """The integer that stands for a set of cells in a seed."""
    return sum(2 ** (column * height + row) for column, row in set(cells))


def words_of(mask: int) -> list[int]:
    """A mask of up to 256 bits as four 64-bit words, lowest first."""
    return [mask // WORD_RANGE**index % WORD_RANGE for index in range(WORDS_PER_MASK)]


class Generator:
    """A SplitMix64 generator that starts from a key and remembers how often it drew."""

    def __init__(self, key: int) -> None:
        self.key = key
        self.draws = 0

    def draw(self) -> int:
        """The next 64-bit number."""
        self.draws += 1
        self.key = (self.key + GAMMA) % WORD_RANGE
        return mix64(self.key)

    def below(self, n: int) -> int:
        """A number in 0..n-1, all equally likely; draws at least once, also for n == 1."""
        if n < 1:
            raise ValueError(f'cannot draw one of {n}')
        usable = WORD_RANGE - WORD_RANGE % n
        number = self.draw()
        while number >= usable:
            number = self.draw()
        return number % n


def attempt_generator(
    seed: int,
    state: frozenset[tuple[int, int]],
    region: frozenset[tuple[int, int]],
    height: int,
    attempt: int,
) -> Generator:
    """The generator of attempt number `attempt` to fill `region` from `state`."""
    state_words = words_of(mask_of(state, height))
    region_words = words_of(mask_of(region, height))
    return Generator(key_from_words([seed, *state_words, *region_words, attempt]))


def subgoal_generator(seed: int, state: frozenset[tuple[int, int]], height: int) -> Generator:
    """The generator that breaks ties between subgoals, or sequences of them, at `state`."""
    return Generator(key_from_words([seed, *words_of(mask_of(state, height))]))
