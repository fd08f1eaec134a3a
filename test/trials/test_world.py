"""The part that owns the board."""

from __future__ import annotations

import pytest
from builders import ARCH, CHAIR, EMPTY, NEVER_SOLVED, NOTHING_FITS, spec
from parts import FOREIGN, FOREIGN_START, HEARD, START, STATES, TRIAL, only, seen, started, tell

from blocks_planning.board.blocks import Block, Placed, Placement
from blocks_planning.trials import world
from blocks_planning.trials.messages import PlaceBlock, PlacementOutcome, WorldState
from blocks_planning.trials.status import TrialStatus


def test_world_clears_its_board_for_a_new_trial() -> None:
    memory, said = tell(world, [START])
    assert said == [seen(TRIAL)]
    place = PlaceBlock(TRIAL.trial_id, 0, Placement(Block(1, 2), 0))
    memory, _ = tell(world, [place], memory)
    _, said = tell(world, [FOREIGN_START], memory)
    assert said == [seen(FOREIGN)]


def test_world_drops_a_block_and_shows_where_it_lies() -> None:
    memory, _ = tell(world, [START])
    _, said = tell(world, [PlaceBlock(TRIAL.trial_id, 0, Placement(Block(1, 2), 3))], memory)
    placed = Placed(1, 2, 3, 0)
    assert said == [PlacementOutcome(TRIAL.trial_id, 0, placed), seen(TRIAL, placed)]
    assert isinstance(said[1], WorldState)
    assert said[1].built == TRIAL.task.board.rectangle(3, 0, 1, 2)


@pytest.mark.parametrize(
    ('rows', 'status'),
    [
        (CHAIR, TrialStatus.BUILDING),
        (EMPTY, TrialStatus.SUCCESS),
        (NOTHING_FITS, TrialStatus.STUCK),
        (NEVER_SOLVED, TrialStatus.BUILDING),
    ],
)
def test_world_says_how_the_board_stands(rows: str, status: TrialStatus) -> None:
    _, [state] = tell(world, [started(spec(rows))])
    assert isinstance(state, WorldState)
    assert state.status is status


def test_world_may_be_built_to_success_and_into_a_dead_end() -> None:
    trial = spec('##/##')
    name = trial.trial_id
    way = [
        PlaceBlock(name, 0, Placement(Block(2, 1), 0)),
        PlaceBlock(name, 1, Placement(Block(2, 1), 0)),
    ]
    _, said = tell(world, [started(trial), *way])
    assert [state.status.value for state in only(WorldState, said)] == [
        'building',
        'building',
        'success',
    ]
    upright = spec('#./##')
    outside = PlaceBlock(upright.trial_id, 0, Placement(Block(1, 2), 1))
    _, said = tell(world, [started(upright), outside])
    # Possible, though not legal: it covers a cell that is no target.
    assert [state.status.value for state in only(WorldState, said)] == ['building', 'building']
    assert only(PlacementOutcome, said)[0].placed == Placed(1, 2, 1, 0)


@pytest.mark.parametrize(
    'placement',
    [
        pytest.param(Placement(Block(2, 1), 3), id='over the right side'),
        pytest.param(Placement(Block(2, 1), -1), id='left of the board'),
        pytest.param(Placement(Block(1, 2), 10**9), id='far away'),
        pytest.param(Placement(Block(1, 2), 0), id='over the top'),
        pytest.param(Placement(Block(3, 1), 1), id='block of no library'),
        pytest.param(Placement(Block(0, 1), 1), id='block without width'),
        pytest.param(Placement(Block(1, 0), 1), id='block without height'),
        pytest.param(Placement(Block(1, -1), 1), id='block of negative height'),
    ],
)
def test_impossible_placement_is_answered_with_a_reason(placement: Placement) -> None:
    name = spec(ARCH).trial_id
    upright = Placement(Block(1, 2), 0)
    memory, said = tell(
        world,
        [started(spec(ARCH)), PlaceBlock(name, 0, upright), PlaceBlock(name, 1, upright)],
    )
    assert said[-1] == memory.state
    after, [outcome] = tell(world, [PlaceBlock(name, 2, placement)], memory)
    assert after == memory
    assert isinstance(outcome, PlacementOutcome)
    assert (outcome.sequence, outcome.placed) == (2, None)
    assert str(placement.block) in outcome.reason
    _, said = tell(world, [PlaceBlock(name, 2, Placement(Block(1, 2), 3))], after)
    assert len(said) == 2


def test_accepted_placement_has_no_reason() -> None:
    outcomes = only(PlacementOutcome, HEARD)
    assert [outcome.reason for outcome in outcomes] == [''] * len(STATES[1:])
    assert [outcome.placed for outcome in outcomes] == list(STATES[-1].placements)
    assert [outcome.sequence for outcome in outcomes] == list(range(len(outcomes)))
