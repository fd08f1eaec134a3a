"""Trials in worlds that need not obey: run, recorded, read back, verified; lies are found."""

from __future__ import annotations

import json
from collections.abc import Iterator
from copy import deepcopy
from itertools import product
from typing import Any

import pytest
from builders import ARCH, CHAIR, EMPTY, FRAME, NOTHING_FITS, ODD, SQUARE, remade, task

from blocks_planning.board.blocks import PAPER_LIBRARY, Placed
from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.errors import RecordError
from blocks_planning.search.searches import BreadthFirst
from blocks_planning.subgoals.decision import Strategy
from blocks_planning.subgoals.full import FullSubgoals
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials import following
from blocks_planning.trials import world as world_part
from blocks_planning.trials.following import Shared, follow
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.reading import record_from_json
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions, differs_from_rerun
from blocks_planning.worlds.observation import MAX_OBSERVATIONS, Observation
from blocks_planning.worlds.world import Observed, Simulated, World

STRATEGIES: list[Strategy] = [
    *(NoSubgoals(aim) for aim in ('perfect', 'most')),
    *(
        Scoping(0.01, commit, aim)
        for commit, aim in product(('subgoal', 'action'), ('perfect', 'most'))
    ),
    *(
        FullSubgoals(0.5, aim, surprise)
        for aim, surprise in product(('perfect', 'most'), ('replan', 'blind'))
    ),
]
WORLDS: list[World] = [
    Simulated(slip=0.3),
    Simulated(loss=0.4),
    Simulated(slip=0.3, loss=0.3),
    Simulated(blocks='loose', edge='falls'),
    Simulated(slip=0.2, loss=0.1, blocks='loose'),
]
TOWERS = [SQUARE, ARCH, CHAIR, FRAME, ODD, NOTHING_FITS, EMPTY]


def trial(
    rows: str, strategy: Strategy, world: World, seed: int = 0, budget: int = 300
) -> TrialSpec:
    return TrialSpec('small', task(rows), strategy, BreadthFirst(2), seed, budget, world)


def holds_everywhere(record: TrialRecord) -> None:
    again = record_from_json(json.loads(record.to_line()), 'test')
    assert again == record
    assert list(contradictions(again)) == []
    assert list(differs_from_rerun(again)) == []


@pytest.mark.parametrize('world', WORLDS, ids=repr)
@pytest.mark.parametrize('strategy', STRATEGIES, ids=repr)
def test_records_of_small_towers_hold(strategy: Strategy, world: World) -> None:
    """Followed and run by its parts the same, read back, and true."""
    for rows in TOWERS:
        for seed in range(3):
            spec = trial(rows, strategy, world, seed)
            record = run_trial(spec)
            assert follow(spec).to_json() == record.to_json()
            holds_everywhere(record)


@pytest.mark.parametrize(
    'tower', ['1', *(pytest.param(tower, marks=pytest.mark.long) for tower in ('7', '13'))]
)
def test_records_of_towers_of_the_paper_hold(tower: str) -> None:
    [stimulus] = find_stimuli(f'cogsci2021/{tower}')
    paper = Task(stimulus.board, stimulus.silhouette, PAPER_LIBRARY)
    shared = Shared()
    for strategy in STRATEGIES:
        for world in WORLDS:
            spec = TrialSpec(tower, paper, strategy, BreadthFirst(1), 3, 2000, world)
            record = follow(spec, shared)
            assert run_trial(spec).to_json() == record.to_json()
            holds_everywhere(record)


@pytest.mark.parametrize('strategy', STRATEGIES, ids=repr)
@pytest.mark.parametrize('rows', TOWERS)
def test_without_chance_it_is_the_obedient_world(strategy: Strategy, rows: str) -> None:
    """Byte for byte but for the world's settings, on the way that asks the world each time."""

    class Asked(Simulated):
        """A simulated world that is not known to obey."""

        @property
        def obeys(self) -> bool:
            return False

    for seed in range(3):
        plain = follow(trial(rows, strategy, Simulated(), seed))
        asked = follow(trial(rows, strategy, Asked(), seed))
        assert asked.to_line() == plain.to_line()


def test_a_loss_replans_nothing() -> None:
    """The decisions and costs of a trial with losses are those of the trial without."""
    for rows, strategy, seed in product(TOWERS, STRATEGIES, range(4)):
        plain = run_trial(trial(rows, strategy, Simulated(), seed))
        lossy = run_trial(trial(rows, strategy, Simulated(loss=0.5), seed))
        assert lossy.placements == plain.placements
        assert [entry.decision for entry in lossy.decisions] == [
            entry.decision for entry in plain.decisions
        ]
        assert lossy.action_planning_cost == plain.action_planning_cost
        assert lossy.subgoal_planning_cost == plain.subgoal_planning_cost
        lost = sum(not seen.landed for seen in lossy.observations[1:])
        assert lossy.orders == plain.orders + lost
        assert lossy.surprises == lost


def test_a_plan_that_is_thrown_away_is_paid_for() -> None:
    """Every decision was paid for, also those whose plans a slip ended."""
    replanned = 0
    for seed in range(20):
        record = run_trial(trial(CHAIR, FullSubgoals(aim='most'), Simulated(slip=0.4), seed))
        considered = [
            sum(candidate.planning_cost for candidate in entry.decision.candidates)
            for entry in record.decisions
        ]
        assert record.subgoal_planning_cost == sum(considered)
        begun = [
            subgoal.planning_cost
            for entry in record.decisions
            for subgoal in entry.decision.subgoals[: entry.executed]
        ]
        assert record.action_planning_cost == sum(begun)
        cut = [e for e in record.decisions if e.executed < len(e.decision.subgoals)]
        replanned += len(record.decisions) > 1 and bool(cut)
    assert replanned


def test_a_blind_planner_plans_once() -> None:
    ends = set()
    for rows, seed in product((SQUARE, ARCH, CHAIR, FRAME), range(10)):
        blind = FullSubgoals(0.5, 'perfect', 'blind')
        record = run_trial(trial(rows, blind, Simulated(slip=0.5), seed))
        first, *rest = record.decisions
        assert all(not entry.decision.candidates for entry in rest)
        assert len(rest) <= 1
        ordered = [seen.ordered for seen in record.observations[1:]]
        plan = [
            placed.placement
            for subgoal in first.decision.subgoals
            for placed in subgoal.placements
        ]
        assert ordered == plan[: len(ordered)]
        ends.add(record.status)
    assert {TrialStatus.SUCCESS, TrialStatus.GAVE_UP} <= ends


@pytest.mark.parametrize('limit', range(2, 9))
def test_trials_end_at_the_most_observations(monkeypatch: pytest.MonkeyPatch, limit: int) -> None:
    """Wherever the limit falls: in a plan, at its end, after a decision."""
    for part in (following, world_part):
        monkeypatch.setattr(part, 'MAX_OBSERVATIONS', limit)
    statuses = set()
    for rows, strategy, seed in product((ARCH, CHAIR), STRATEGIES, range(3)):
        spec = trial(rows, strategy, Simulated(slip=0.1, loss=0.4), seed)
        record = run_trial(spec)
        assert len(record.observations) <= limit
        assert follow(spec).to_json() == record.to_json()
        holds_everywhere(record)
        statuses.add(record.status)
    assert TrialStatus.CANCELLED in statuses


def test_a_world_that_always_loses_ends_the_trial() -> None:
    record = run_trial(trial(ARCH, Scoping(), Simulated(loss=1)))
    assert record.status is TrialStatus.CANCELLED
    assert len(record.observations) == MAX_OBSERVATIONS
    assert 'observations' in record.reason
    assert len(record.decisions) == 1
    assert follow(record.spec).to_json() == record.to_json()


def test_loose_towers_collapse_and_nothing_follows() -> None:
    seen = set()
    for seed in range(10):
        record = run_trial(trial(CHAIR, NoSubgoals(), Simulated(blocks='loose'), seed))
        for length in range(1, len(record.placements)):
            assert record.spec.world.holds(record.placements[:length])
        collapsed = not record.spec.world.holds(record.placements)
        assert collapsed == (record.status is TrialStatus.COLLAPSED)
        seen.add(collapsed)
    assert seen


# Lies.

SLIPPED = run_trial(trial(CHAIR, Scoping(0.01, aim='most'), Simulated(slip=0.4, loss=0.3), 20))
LIED = json.loads(SLIPPED.to_line())


def found(data: dict[str, Any]) -> list[str]:
    try:
        return list(contradictions(record_from_json(remade(data), 'x')))
    except RecordError as error:
        return [str(error)]


def falsified() -> Iterator[tuple[str, dict[str, Any]]]:
    """Every observation as it was not drawn."""
    for sequence, seen in enumerate(LIED['observations'][1:], start=1):
        changes: dict[str, dict[str, Any]] = {
            'lost': {'landed': []},
            'as ordered': {'landed': [[*seen['ordered'], 0]]},
            'left': {'landed': [[*b[:2], b[2] - 1, b[3]] for b in seen['landed']]},
            'right': {'landed': [[*b[:2], b[2] + 1, b[3]] for b in seen['landed']]},
            'not ordered': {'ordered': None},
            'not there': {'gone': [[1, 2, 7, 7]]},
        }
        for name, change in changes.items():
            if {**seen, **change} != seen:
                data = deepcopy(LIED)
                data['observations'][sequence] |= change
                yield f'{sequence} {name}', data


def test_the_true_record_holds_and_something_happened() -> None:
    holds_everywhere(SLIPPED)
    assert found(deepcopy(LIED)) == []
    assert any(not seen.landed for seen in SLIPPED.observations[1:])
    assert any(seen.landed and not seen.is_as_ordered for seen in SLIPPED.observations[1:])


@pytest.mark.parametrize(('name', 'data'), list(falsified()), ids=lambda value: str(value)[:14])
def test_what_was_not_drawn_is_found(name: str, data: dict[str, Any]) -> None:
    assert found(data), name


@pytest.mark.parametrize('key', ['recall', 'precision', 'f1', 'iou', 'surprises', 'orders'])
def test_wrong_measures_are_found(key: str) -> None:
    data = deepcopy(LIED)
    data[key] += 1
    with pytest.raises(RecordError, match=key):
        record_from_json(data, 'x')


def test_observed_records_are_judged_by_what_can_stand() -> None:
    """Two narrow blocks become one wide one while an order is carried out: the same cells."""
    tower = task('##/##/##/##', '1x2,2x1')
    plain = run_trial(
        TrialSpec('small', tower, NoSubgoals(), BreadthFirst(3), 0, 300, Simulated())
    )
    first, *rest = plain.observations[1:]
    spec = TrialSpec('small', tower, NoSubgoals(), BreadthFirst(3), 0, 300, Observed())
    exchanged = _exchanged(first.landed[0])
    if exchanged is None:
        pytest.fail(f'the first block is {first.landed[0]}, which cannot be exchanged')
    change = Observation(None, exchanged, first.landed)
    observations = (plain.observations[0], first, change, *rest)
    record = TrialRecord(spec, plain.status, observations, plain.decisions)
    assert list(contradictions(record)) == []
    floating = Observation(None, (Placed(1, 2, 0, 2),), first.landed)
    wrong = TrialRecord(
        spec, plain.status, (plain.observations[0], first, floating, *rest), plain.decisions
    )
    assert any('observation 2' in sentence for sentence in contradictions(wrong))


def _exchanged(placed: Placed) -> tuple[Placed, ...] | None:
    """Two blocks with the cells of one."""
    if placed.width == 2:
        return tuple(
            Placed(1, placed.height, column, placed.row)
            for column in (placed.column, placed.column + 1)
        )
    if placed.height == 2:
        return tuple(
            Placed(placed.width, 1, placed.column, row) for row in (placed.row, placed.row + 1)
        )
    return None
