"""What simulated worlds draw, and what each world refuses to have observed."""

from __future__ import annotations

import random
from collections import Counter
from fractions import Fraction
from typing import Any

import pytest
from oracles.board import Placement as PlainPlacement
from oracles.slipping import outcomes
from oracles.tree import Task as PlainTask
from problems import random_problem

from blocks_planning.board import rules
from blocks_planning.board.blocks import PAPER_LIBRARY, Block, Placed, Placement
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError
from blocks_planning.worlds.observation import Observation
from blocks_planning.worlds.world import ImpossibleOrder, Observed, Simulated, make_world

BOARD = Board(5, 4)
TASK = Task(BOARD, BOARD.full, PAPER_LIBRARY)
MIDDLE = Placement(Block(1, 2), 2)
LANDED = Placed(1, 2, 2, 0)
DRAWS = 4000


@pytest.mark.parametrize('column', [0, 2, 4])
def test_draws_have_the_distribution_of_the_twin(column: int) -> None:
    """Within 4.5 standard deviations, at the border of the board too."""
    built = rules.cells_of(BOARD, Placed(1, 4, 1, 0))  # a full column: nothing lands in it
    order = Placement(Block(1, 2), column)
    world = Simulated(slip=0.4, loss=0.25)
    seen: Counter[Any] = Counter()
    for number in range(DRAWS):
        observed = world.carry_out(TASK, built, order, number % 97, 1 + number // 97)
        assert observed.ordered == order
        assert not observed.gone
        seen[observed.landed[0] if observed.landed else None] += 1
    library = tuple(tuple(block) for block in PAPER_LIBRARY)
    plain = PlainTask(5, 4, library, frozenset())  # type: ignore[arg-type]
    state = frozenset(BOARD.cells(built))
    placed = PlainPlacement(1, 2, column, 0)
    expected = outcomes(plain, state, placed, Fraction(2, 5), Fraction(1, 4))
    assert set(seen) == {place and Placed(*place) for place in expected}
    for place, chance in expected.items():
        error = (float(chance * (1 - chance)) / DRAWS) ** 0.5
        share = seen[place and Placed(*place)] / DRAWS
        assert abs(share - float(chance)) < 4.5 * error


def test_a_draw_depends_on_seed_and_sequence_alone() -> None:
    world = Simulated(slip=0.5, loss=0.3)
    drawn = {
        (seed, sequence): world.carry_out(TASK, 0, MIDDLE, seed, sequence)
        for seed in range(8)
        for sequence in range(1, 8)
    }
    again = Simulated(slip=0.5, loss=0.3)
    for (seed, sequence), seen in reversed(drawn.items()):
        assert again.carry_out(TASK, 0, MIDDLE, seed, sequence) == seen
    assert len({drawn[seed, 1] for seed in range(8)}) > 1
    assert len({drawn[1, sequence] for sequence in range(1, 8)}) > 1


def test_without_chance_every_order_is_carried_out() -> None:
    source = random.Random(3)
    for seed in range(40):
        problem = random_problem(source)
        for placed in rules.legal_placements(problem.task, problem.built, problem.region):
            seen = Simulated().carry_out(problem.task, problem.built, placed.placement, seed, 1)
            assert seen == Observation(placed.placement, (placed,))


def test_a_world_obeys_only_without_chance_and_glued() -> None:
    assert Simulated().obeys
    assert Simulated(edge='falls').obeys
    disobedient = (
        *(Simulated(slip=0.01), Simulated(loss=0.01), Simulated(blocks='loose'), Observed()),
    )
    assert not any(world.obeys for world in disobedient)


@pytest.mark.parametrize(
    ('built', 'order', 'reason'),
    [
        (0, Placement(Block(3, 1), 0), 'not in the library'),
        (0, Placement(Block(1, 2), 5), 'does not come to rest inside'),
        (0, Placement(Block(1, 2), -1), 'does not come to rest inside'),
        (rules.cells_of(BOARD, Placed(1, 3, 2, 0)), MIDDLE, 'does not come to rest inside'),
    ],
)
def test_impossible_order_is_refused(built: Mask, order: Placement, reason: str) -> None:
    for world in (Simulated(), Simulated(slip=0.5, loss=0.5)):
        with pytest.raises(ImpossibleOrder, match=reason):
            world.carry_out(TASK, built, order, 0, 1)
        seen = Observation(order)
        assert reason in world.complaint(TASK, (), built, seen, 0, 1)


def test_only_the_drawn_outcome_is_believed() -> None:
    world = Simulated(slip=0.4, loss=0.3)
    places = [(), *((Placed(1, 2, column, 0),) for column in (1, 2, 3))]
    for sequence in range(1, 30):
        drawn = world.carry_out(TASK, 0, MIDDLE, 7, sequence)
        for landed in places:
            seen = Observation(MIDDLE, landed)
            found = world.complaint(TASK, (), 0, seen, 7, sequence)
            assert (found == '') == (seen == drawn)
        gone = drawn._replace(gone=(LANDED,))
        assert 'differs from the one that this world draws' in world.complaint(
            TASK, (LANDED,), 0, gone, 7, sequence
        )
    assert 'without an order' in world.complaint(TASK, (), 0, Observation(None, (LANDED,)), 7, 1)


@pytest.mark.parametrize(
    ('seen', 'reason'),
    [
        (Observation(MIDDLE, (Placed(2, 2, 3, 0),)), ''),  # another block, another place
        (Observation(None, (Placed(4, 2, 0, 2),)), ''),  # a person's hand
        (Observation(None, (), (LANDED,)), ''),
        (Observation(MIDDLE, (LANDED,)), 'overlaps'),
        (Observation(None, (Placed(1, 2, 0, 1),)), 'rests on nothing'),
        (Observation(None, (Placed(1, 2, 5, 0),)), 'does not lie inside'),
        (Observation(None, (), (Placed(1, 2, 3, 0),)), 'was not on the board'),
        (Observation(None, (Placed(4, 2, 0, 2),), (LANDED,)), 'rests on nothing'),
    ],
)
def test_observed_is_what_can_stand(seen: Observation, reason: str) -> None:
    built = rules.cells_of(BOARD, LANDED)
    found = Observed().complaint(TASK, (LANDED,), built, seen, 0, 1)
    assert (reason in found) if reason else not found


def test_observed_carries_out_nothing() -> None:
    assert not Observed.simulates
    assert Observed().holds((Placed(4, 2, 0, 2),))
    with pytest.raises(ImpossibleOrder, match='does not carry out orders'):
        Observed().carry_out(TASK, 0, MIDDLE, 0, 1)


def test_loose_blocks_fall_and_the_edge_is_a_setting() -> None:
    slab = Placed(4, 2, 0, 2)
    falls = (Placed(1, 2, 0, 0), slab)
    edge = (Placed(2, 2, 0, 0), slab)
    stands = (Placed(1, 2, 0, 0), Placed(1, 2, 3, 0), slab)
    answers = [Simulated(blocks='loose').holds(blocks) for blocks in (falls, edge, stands)]
    assert answers == [False, True, True]
    strict = Simulated(blocks='loose', edge='falls')
    assert [strict.holds(blocks) for blocks in (falls, edge, stands)] == [False, False, True]
    assert Simulated(edge='falls').holds(falls)


@pytest.mark.parametrize(
    'values', [{'slip': 1.01}, {'loss': -0.1}, {'slip': 'x'}, {'blocks': 'wet'}, {'edge': 'so'}]
)
def test_wrong_settings_are_refused(values: dict[str, Any]) -> None:
    with pytest.raises(ConfigurationError, match=next(iter(values))):
        make_world('simulated', values)
