"""Statics of loose blocks: cases worked out by hand, the exact twin, and towers people built."""

from __future__ import annotations

import random
import sys
from collections import Counter
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace

import pytest
import scipy.optimize
import yaml
from oracles import statics as twin
from oracles.board import Placement as PlainPlacement

from blocks_planning.board import rules, statics
from blocks_planning.board.blocks import PAPER_LIBRARY, Block, Placed
from blocks_planning.board.contacts import Contact, is_carried, must_tip, structure_of
from blocks_planning.board.geometry import Board
from blocks_planning.board.statics import (
    MARGIN,
    Stability,
    decide_by_program,
    decide_fast,
    holds,
    stability,
)
from blocks_planning.errors import BlocksPlanningError, ConfigurationError

GOLDEN = Path(__file__).parents[1] / 'golden' / 'people_towers.yaml'
HALF = Fraction(1, 2)

# Blocks as 'width x height @ column, row'. The centre of each is at column + width / 2.
CASES = {
    'nothing at all': ('', 'stands'),
    'a block on the ground': ('1x2@3,0', 'stands'),
    'a block in the air': ('2x2@0,1', 'falls'),
    'a bridge': ('1x2@0,0 1x2@3,0 4x2@0,2', 'stands'),
    'an arch of the library': ('2x4@0,0 2x4@4,0 4x2@1,4 2x2@2,6', 'stands'),
    'centre over the support': ('2x2@1,0 4x2@0,2', 'stands'),
    'cantilever at its limit': ('2x2@0,0 4x2@0,2', 'edge'),
    'cantilever beyond its limit': ('1x2@0,0 4x2@0,2', 'falls'),
    # The centre of both is at (8 * 2 + 8 * 1) / 16 = 1.5 < 2.
    'counterweight': ('2x2@0,0 4x2@0,2 2x4@0,4', 'stands'),
    'counterweight on the wrong side': ('2x2@0,0 4x2@0,2 2x4@2,4', 'falls'),
    # The centre of 8 + 1 cells is at (8 * 2 + 0.5) / 9 = 1.83 < 2.
    'half a cell beyond, and a small weight': ('2x1@0,0 4x2@0,1 1x1@0,3', 'stands'),
    # Friction at the top and the base of both arms turns them back: see test_friction_can_decide.
    'a bridge of two cantilevers': ('1x1@0,0 1x1@3,0 2x1@0,1 2x1@2,1 2x1@1,2', 'stands'),
    'a pile on one cell': ('1x2@4,0 2x1@4,2', 'edge'),
    # The upper two have their centre at (2.5 + 3.5) / 2 = 3, where their support ends.
    'stairs': ('3x1@0,0 3x1@1,1 3x1@2,2', 'edge'),
    'stairs of long blocks': ('4x1@0,0 4x1@1,1 4x1@2,2', 'stands'),
    # With a fourth the top three have their centre at 3.5 and the support ends at 3.
    'stairs that are too long': ('3x1@0,0 3x1@1,1 3x1@2,2 3x1@3,3', 'falls'),
}


def read_blocks(text: str) -> tuple[Placed, ...]:
    blocks = []
    for word in text.split():
        size, place = word.split('@')
        blocks.append(Placed(*map(int, size.split('x')), *map(int, place.split(','))))
    return tuple(blocks)


def drop_at_random(source: random.Random, board: Board, number: int) -> list[Placed]:
    sides = [1, 1, 2, 2, 3, 4]
    library = source.choice(
        [PAPER_LIBRARY, tuple({Block(source.choice(sides), source.choice(sides)) for _ in 'abcd'})]
    )
    built, blocks = 0, []
    for _ in range(number):
        possible = list(rules.possible_placements(board, built, library))
        if possible:
            blocks.append(source.choice(possible))
            built |= rules.cells_of(board, blocks[-1])
    return blocks


@pytest.mark.parametrize('name', CASES)
def test_case_worked_out_by_hand(name: str) -> None:
    text, expected = CASES[name]
    blocks = read_blocks(text)
    assert stability(blocks).value == expected
    assert stability(reversed(blocks)).value == expected
    assert decide_by_program(structure_of(blocks), 0.5).value == expected
    known = decide_fast(structure_of(blocks))
    assert known is None or known.value == expected


def test_agrees_with_its_exact_twin() -> None:
    source = random.Random(4)
    seen: Counter[str] = Counter()
    for _ in range(60):
        blocks = drop_at_random(source, Board(5, 6), source.randint(1, 4))
        plain = [PlainPlacement(*block) for block in blocks]
        expected = twin.stability(plain, HALF, Fraction(1, 50))
        assert decide_by_program(structure_of(blocks), 0.5).value == expected, blocks
        assert stability(blocks).value == expected, blocks
        seen[expected] += 1
    assert min(seen[kind] for kind in ('stands', 'edge', 'falls')) > 3


def test_fast_case_and_program_agree_on_high_towers() -> None:
    source = random.Random(5)
    seen: Counter[Stability | None] = Counter()
    for _ in range(60):
        structure = structure_of(drop_at_random(source, Board(8, 8), source.randint(5, 9)))
        known = decide_fast(structure)
        seen[known] += 1
        assert known in (None, decide_by_program(structure, 0.5))
    assert min(seen[kind] for kind in Stability) > 3


@pytest.mark.parametrize(('friction', 'expected'), [(0.06, 'edge'), (0.1, 'stands')])
def test_friction_can_decide(friction: float, expected: str) -> None:
    """A bridge of two cantilevers: what turns back an arm at its base and its top.

    Moments about the end of an arm's support, 0.98: its own weight 2 at 1 and half of the upper
    block's, 1 at 1.02, give 2 * 0.02 + 0.04 = 0.08. Friction at the top, one cell above the base,
    is at most mu * 1. So mu must be at least 0.08.
    """
    blocks = read_blocks(CASES['a bridge of two cantilevers'][0])
    assert decide_fast(structure_of(blocks)) is None
    assert stability(blocks, friction).value == expected
    plain = [PlainPlacement(*block) for block in blocks]
    assert twin.stability(plain, Fraction(friction), Fraction(1, 50)) == expected


def test_towers_that_people_built_do_not_fall() -> None:
    towers = yaml.safe_load(GOLDEN.read_text(encoding='utf-8'))['towers']
    assert len(towers) == 24
    for tower in towers:
        found = stability(read_blocks(tower['blocks']))
        assert found.value == tower['found']
        assert found is not Stability.FALLS


def test_edge_may_count_as_standing_or_not() -> None:
    stands, edge, falls = (
        read_blocks(CASES[name][0])
        for name in ('a bridge', 'cantilever at its limit', 'cantilever beyond its limit')
    )
    assert [holds(blocks) for blocks in (stands, edge, falls)] == [True, True, False]
    answers = [holds(blocks, edge_stands=False) for blocks in (stands, edge, falls)]
    assert answers == [True, False, False]


def test_contacts_are_intervals_below_a_block() -> None:
    structure = structure_of(read_blocks('1x2@0,0 1x2@3,0 4x2@0,2'))
    assert structure.blocks == read_blocks('4x2@0,2 1x2@0,0 1x2@3,0')
    assert structure.below == (
        (Contact(0, 1, 0, 1), Contact(0, 2, 3, 4)),
        (Contact(1, None, 0, 1),),
        (Contact(2, None, 3, 4),),
    )


def test_touching_at_a_corner_or_a_side_is_no_contact() -> None:
    structure = structure_of(read_blocks('1x1@0,0 1x1@1,1 1x1@2,1'))
    assert structure.below[:2] == ((), ())
    assert stability(structure.blocks) is Stability.FALLS


def test_margin_is_exact() -> None:
    """A slab whose centre is as far from the end of its support as the margin, or just less."""
    # The centre of 24 + 1 cells is at (24 * 2 + 0.5) / 25 = 1.94.
    inside = structure_of(read_blocks('2x1@0,0 4x6@0,1 1x1@0,7'))
    assert not must_tip(inside, Fraction(6, 100))
    assert must_tip(inside, Fraction(6, 100) + Fraction(1, 10**12))
    assert is_carried(inside, Fraction(6, 100))
    assert not is_carried(inside, Fraction(6, 100) + Fraction(1, 10**12))
    assert Fraction(2, 100) == MARGIN


def test_answers_are_remembered(monkeypatch: pytest.MonkeyPatch) -> None:
    blocks = read_blocks('2x4@0,0 2x2@7,0 2x1@7,2')
    first = stability(blocks)
    monkeypatch.setattr(statics, 'structure_of', None)
    assert stability(blocks[::-1]) is first


def test_needs_scipy_only_where_it_is_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    statics._remembered.cache_clear()
    monkeypatch.setitem(sys.modules, 'scipy.optimize', None)
    assert stability(read_blocks(CASES['a bridge'][0])) is Stability.STANDS
    with pytest.raises(
        ConfigurationError, match='the module scipy is not installed; it comes with the extra'
    ):
        stability(read_blocks(CASES['a bridge of two cantilevers'][0]))


def test_solver_that_gives_up_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    answer = SimpleNamespace(status=4, message='numerical difficulties')
    monkeypatch.setattr(scipy.optimize, 'linprog', lambda **_: answer)
    structure = structure_of(read_blocks(CASES['a bridge'][0]))
    with pytest.raises(BlocksPlanningError, match='ended with: numerical difficulties'):
        decide_by_program(structure, 0.5)
