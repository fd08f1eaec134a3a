"""How far a plan has come: the drawing in the docstring, and what blind planners make of it."""

from __future__ import annotations

import pytest
from builders import task

from blocks_planning.board.blocks import Block, Placed
from blocks_planning.search.searches import RandomPlacement
from blocks_planning.subgoals.decision import Strategy, Subgoal
from blocks_planning.subgoals.full import FullSubgoals
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.regions import Region, rows_label
from blocks_planning.trials.execution import Progress, history, progress_of
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.worlds.observation import Observation, mask_of
from blocks_planning.worlds.world import Observed

TASK = task('......../########', '1x1,1x2,2x1')
PLAN = tuple(Placed(2, 1, column, 0) for column in (0, 2, 4))
A, B, C = (Observation(placed.placement, (placed,)) for placed in PLAN)
LOST_A, LOST_B = (Observation(placed.placement) for placed in PLAN[:2])
SLIPPED_A = Observation(PLAN[0].placement, (Placed(2, 1, 1, 0),))
SLIPPED_C = Observation(PLAN[2].placement, (Placed(2, 1, 5, 0),))
HIGH = Observation(PLAN[0].placement, (Placed(1, 2, 2, 0),))
NONE, BLIND = NoSubgoals(), FullSubgoals(surprise='blind')


def progress(
    strategy: Strategy,
    seen: tuple[Observation, ...],
    *,
    start: int = 0,
    execute: int = 3,
    found: tuple[Placed, ...] = (),
) -> Progress:
    """Of the plan, from the board as it was found."""
    board = TASK.board
    spec = TrialSpec('row', TASK, strategy, RandomPlacement(), world=Observed())
    built = mask_of(board, found)
    target = built | mask_of(board, PLAN)
    subgoal = Subgoal(Region(rows_label(1), target), target, execute, PLAN, 0, 0, 1)
    observations = (Observation(landed=found), *seen)
    return progress_of(spec, built, subgoal, start, history(board, observations))


def test_the_drawing() -> None:
    """Sequences 4 to 8: as ordered, lost, as ordered, and something else."""
    board = TASK.board
    spec = TrialSpec('row', TASK, NONE, RandomPlacement(), world=Observed())
    before = tuple(Observation(None, (Placed(1, 1, 7, row),)) for row in range(2))
    seen = (Observation(), *before, Observation(), Observation())
    built = mask_of(board, [Placed(1, 2, 7, 0)])
    subgoal = Subgoal(Region(rows_label(1), 0), built | mask_of(board, PLAN), 3, PLAN, 0, 0, 1)
    expected = [
        (0, 4, False, False),
        (1, 5, False, False),
        (1, 6, False, False),
        (2, 7, False, False),
        (2, 8, False, True),
    ]
    steps = (A, LOST_B, B, SLIPPED_C)
    for count, answer in enumerate(expected):
        observed = history(board, (*seen, *steps[:count]))
        assert progress_of(spec, built, subgoal, 4, observed) == answer


@pytest.mark.parametrize(
    ('seen', 'expected'),
    [
        ((), (0, 0, False, False)),
        ((LOST_A, LOST_A), (0, 2, False, False)),
        ((A, B, C), (3, 3, True, False)),
        ((LOST_A, A, LOST_B, B, C), (3, 5, True, False)),
        ((SLIPPED_A,), (0, 1, False, True)),
        ((A, Observation(None, (), (PLAN[0],))), (1, 2, False, True)),
        # What comes after a surprise, or after the end, is not looked at.
        ((SLIPPED_A, B), (0, 1, False, True)),
        ((A, B, C, Observation(None, (Placed(1, 2, 7, 0),))), (3, 3, True, False)),
        # A hand that does what comes next does what was planned.
        ((A, Observation(None, (PLAN[1],))), (2, 2, False, False)),
        # Two steps at once are a surprise.
        ((Observation(None, PLAN[:2]),), (0, 1, False, True)),
        # Other blocks in the same cells are no change.
        (
            (A, Observation(None, (Placed(1, 1, 0, 0), Placed(1, 1, 1, 0)), (PLAN[0],)), B),
            (2, 3, False, False),
        ),
    ],
)
def test_who_looks(seen: tuple[Observation, ...], expected: tuple[int, int, bool, bool]) -> None:
    assert progress(NONE, seen) == expected
    assert progress(NONE, seen).is_open == (not expected[2] and not expected[3])


@pytest.mark.parametrize(
    ('seen', 'expected'),
    [
        ((LOST_A, LOST_A), (0, 2, False, False)),
        ((SLIPPED_A, B, C), (3, 3, True, False)),
        ((SLIPPED_A, LOST_B), (1, 2, False, False)),
        # The next order is in columns 2 and 3, where a column is full.
        ((HIGH,), (1, 1, False, True)),
        # A hand carries out no order.
        ((Observation(None, (Placed(1, 1, 7, 0),)),), (0, 1, False, False)),
        ((A, Observation(None, (), (PLAN[0],)), B, C), (3, 4, True, False)),
    ],
)
def test_who_is_blind(
    seen: tuple[Observation, ...], expected: tuple[int, int, bool, bool]
) -> None:
    assert progress(BLIND, seen) == expected


@pytest.mark.parametrize('strategy', [NONE, BLIND])
def test_only_what_is_to_be_executed_counts(strategy: Strategy) -> None:
    assert progress(strategy, (A, B), execute=1) == (1, 1, True, False)
    assert progress(strategy, (A,), execute=2) == (1, 1, False, False)


def test_a_plan_from_another_state_is_a_surprise_at_once() -> None:
    assert progress(NONE, (A, B), start=1) == (0, 1, False, True)


def test_blind_counts_from_its_start() -> None:
    assert progress(BLIND, (SLIPPED_A, B), start=1) == (1, 2, False, False)


def test_what_was_found_is_no_order() -> None:
    found = (Placed(1, 1, 7, 0),)
    assert progress(BLIND, (), found=found) == (0, 0, False, False)
    assert Block(2, 1) == PLAN[0].placement.block
