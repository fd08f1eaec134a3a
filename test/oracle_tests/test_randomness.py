"""The slow generator against published and hand-made numbers."""

from __future__ import annotations

import pytest
from oracles.randomness import (
    Generator,
    attempt_generator,
    key_from_words,
    mask_of,
    subgoal_generator,
    words_of,
)
from small_boards import full_board


def test_splitmix64_gives_its_published_numbers() -> None:
    generator = Generator(1234567)
    assert [generator.draw() for _ in range(5)] == [
        6457827717110365317,
        3203168211198807973,
        9817491932198370423,
        4593380528125082431,
        16408922859458223821,
    ]
    generator = Generator(0)
    assert [generator.draw() for _ in range(3)] == [
        0xE220A8397B1DCDAF,
        0x6E789E6AA1B965F4,
        0x06C45D188009454F,
    ]


def test_key_of_words_is_a_chain_of_first_outputs() -> None:
    # key = mix64((key ^ word) + GAMMA) is the first output of a generator with key ^ word.
    assert key_from_words([]) == 0
    assert key_from_words([0]) == 0xE220A8397B1DCDAF
    assert key_from_words([1234567]) == 6457827717110365317
    second = Generator(6457827717110365317 ^ 89).draw()
    assert key_from_words([1234567, 89]) == second
    # A second word that undoes the first key brings the key back to 0 before mixing.
    assert key_from_words([7, key_from_words([7])]) == 0xE220A8397B1DCDAF


@pytest.mark.parametrize('word', [-1, 2**64])
def test_seed_words_must_fit(word: int) -> None:
    with pytest.raises(ValueError, match='seed word'):
        key_from_words([word])


def test_below_takes_the_remainder() -> None:
    generator = Generator(1234567)
    assert [generator.below(10) for _ in range(3)] == [7, 3, 3]


def test_below_draws_also_when_there_is_nothing_to_choose() -> None:
    generator = Generator(1234567)
    assert generator.below(1) == 0
    assert generator.draws == 1
    assert generator.draw() == 3203168211198807973


def test_below_rejects_the_uneven_rest() -> None:
    # 2**64 mod (2**63 + 1) = 2**63 - 1, so numbers from 2**63 + 1 on are drawn again:
    # of the published numbers the third is one of these, the fourth is not.
    generator = Generator(1234567)
    n = 2**63 + 1
    assert generator.below(n) == 6457827717110365317
    assert generator.below(n) == 3203168211198807973
    assert generator.below(n) == 4593380528125082431
    assert generator.draws == 4


def test_below_nothing_is_an_error() -> None:
    with pytest.raises(ValueError, match='one of 0'):
        Generator(0).below(0)


def test_masks_and_their_words() -> None:
    # Height 3: (0, 0) is bit 0, (0, 2) bit 2, (1, 0) bit 3.
    assert mask_of({(0, 0), (0, 2), (1, 0)}, 3) == 1 + 4 + 8
    # Height 8: (7, 7) is bit 63, the highest of the first word.
    assert words_of(mask_of({(7, 7)}, 8)) == [2**63, 0, 0, 0]
    # Height 16: (4, 0) is bit 64, (15, 15) bit 255.
    assert words_of(mask_of({(4, 0), (15, 15)}, 16)) == [0, 1, 0, 2**63]


def test_generators_are_made_of_seed_state_region_attempt() -> None:
    state, region = frozenset({(0, 0)}), full_board(2, 2)
    expected = key_from_words([5, 1, 0, 0, 0, 15, 0, 0, 0, 3])
    assert attempt_generator(5, state, region, 2, 3).key == expected
    assert subgoal_generator(5, state, 2).key == key_from_words([5, 1, 0, 0, 0])
