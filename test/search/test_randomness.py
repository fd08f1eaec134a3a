"""The generator of ties."""

from __future__ import annotations

import random
from collections import Counter

import numpy as np
import pytest
from oracles import randomness as oracle

from blocks_planning.board.kernels.compiling import kernel
from blocks_planning.search.kernels.randomness import below
from blocks_planning.search.randomness import Generator, mask_words, mix

SOURCE = random.Random(1)
WORDS = [[SOURCE.getrandbits(64) for _ in range(length)] for length in (0, 1, 5, 10)]


@pytest.mark.parametrize('words', WORDS, ids=len)
@pytest.mark.parametrize('bound', [1, 2, 7, 1000, 2**32 + 1, 2**63 + 1, 2**64 - 1])
def test_numbers_are_those_of_the_slow_twin(words: list[int], bound: int) -> None:
    generator, twin = Generator(words), oracle.Generator(oracle.key_from_words(words))
    assert [generator.below(bound) for _ in range(20)] == [twin.below(bound) for _ in range(20)]


@kernel
def _draw_below(generator, bound, draws):
    for index in range(draws.size):
        draws[index] = below(generator, bound)


# The draws of the last two bounds are refused with probabilities of about 1/4 and 0.
@pytest.mark.parametrize('bound', [1, 2, 7, 1000, 2**32 + 1, 2**62 + 1, 2**62])
def test_compiled_numbers_are_those_of_the_slow_twin(bound: int) -> None:
    key = mix(bound)
    twin, draws = oracle.Generator(key), np.zeros(200, np.int64)
    _draw_below(np.array([key], np.uint64), bound, draws)
    assert draws.tolist() == [twin.below(bound) for _ in draws]


def test_a_bound_that_refuses_half_of_all_draws_is_uniform_still() -> None:
    generator = Generator([1])
    low = sum(generator.below(2**63 + 1) < 2**62 for _ in range(4000))
    assert abs(low - 2000) < 5 * 32  # five standard deviations


@pytest.mark.parametrize('bound', [2, 3, 6, 10, 37])
def test_first_draws_of_neighbouring_seeds_are_uniform(bound: int) -> None:
    draws = 2000 * bound
    counts = Counter(Generator([seed, *mask_words(0)]).below(bound) for seed in range(draws))
    chi_square = sum((counts[value] - 2000) ** 2 / 2000 for value in range(bound))
    assert chi_square < bound - 1 + 5 * (2 * (bound - 1)) ** 0.5


def test_order_and_number_of_words_matter() -> None:
    firsts = {Generator(words).below(2**64 - 1) for words in ([], [0], [0, 0], [1, 0], [0, 1])}
    assert len(firsts) == 5


def test_mixing_is_a_bijection_that_spreads_single_bits() -> None:
    images = [mix(1 << bit) for bit in range(64)]
    assert len(set(images)) == 64
    assert all(20 <= image.bit_count() <= 44 for image in images)


def test_words_of_a_mask() -> None:
    assert mask_words(1 << 255 | 1 << 64 | 5) == [5, 1, 0, 1 << 63]
