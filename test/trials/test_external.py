"""Strategy and search ``external``: another program takes part, and its record is judged."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from builders import ARCH, spec

from blocks_planning import decide, make_search, make_strategy, run_trial, run_trials
from blocks_planning.errors import ConfigurationError
from blocks_planning.search.external import ExternalSearch
from blocks_planning.search.result import Problem, SolveStatus
from blocks_planning.search.searches import make_own_search
from blocks_planning.search.solve import solve
from blocks_planning.subgoals.decision import Decision
from blocks_planning.subgoals.external import ExternalStrategy
from blocks_planning.subgoals.registry import make_planner
from blocks_planning.trials import searcher, selector
from blocks_planning.trials.messages import TrialStarted, observed
from blocks_planning.trials.reading import record_from_json
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions, differs_from_rerun
from blocks_planning.worlds.observation import Observation

OWN = spec(ARCH)
BY_PROGRAM = {
    'strategy': replace(OWN, strategy=ExternalStrategy('mine')),
    'search': replace(OWN, search=ExternalSearch('mine')),
}
BOTH = pytest.mark.parametrize('family', BY_PROGRAM)
RUNS: list[Callable[[TrialSpec], Any]] = [run_trial, decide, lambda one: run_trials([one])]


@BOTH
@pytest.mark.parametrize('run', RUNS)
def test_one_process_refuses_it(family: str, run: Callable[[TrialSpec], Any]) -> None:
    with pytest.raises(ConfigurationError, match=rf"{family} external .* program 'mine'.* graph"):
        run(BY_PROGRAM[family])


def test_a_sweep_and_a_solve_refuse_it() -> None:
    with pytest.raises(ConfigurationError, match='strategy external'):
        make_planner('external', {})
    with pytest.raises(ConfigurationError, match='search external'):
        make_own_search('external', {})
    problem = Problem(OWN.task, 0, OWN.task.silhouette)
    with pytest.raises(ConfigurationError, match='search external'):
        solve(problem, ExternalSearch(), 0)


@pytest.mark.parametrize('make', [make_strategy, make_search])
@pytest.mark.parametrize('program', ['', 'a b', 'x' * 65, 'a\nb', 3])
def test_a_name_that_can_not_be_is_refused(make: Any, program: object) -> None:
    with pytest.raises(ConfigurationError, match='program'):
        make('external', {'program': program})


@pytest.mark.parametrize(('family', 'part'), [('strategy', selector), ('search', searcher)])
def test_the_part_leaves_the_trial_to_the_program(family: str, part: Any) -> None:
    begun = TrialStarted('one', BY_PROGRAM[family])
    state = observed('one', OWN.task.board, (Observation(),), TrialStatus.BUILDING)
    memory, said = part.step(part.Memory(), begun)
    assert part.step(memory, state) == (part.Memory(), ())
    assert said == ()
    memory, _ = part.step(part.Memory(), TrialStarted('one', OWN))
    assert part.step(memory, state)[0] != part.Memory()


def of_program(family: str, strategy: str = 'scoping') -> TrialRecord:
    """A record as a program would leave it that decides or searches as one of ours does."""
    record: TrialRecord = run_trial(replace(OWN, strategy=make_strategy(strategy, {})))
    member = getattr(BY_PROGRAM[family], family)
    return replace(record, spec=replace(record.spec, **{family: member}))


@pytest.mark.parametrize(
    ('family', 'strategy'),
    [('strategy', 'scoping'), ('strategy', 'full'), ('search', 'none'), ('search', 'scoping')],
)
def test_its_record_bears_the_name_and_is_consistent(family: str, strategy: str) -> None:
    record = of_program(family, strategy)
    again = record_from_json(record.to_json(), 'here')
    assert again == record
    assert getattr(again.spec, family).program == 'mine'
    assert list(contradictions(again)) == []
    assert list(differs_from_rerun(again)) == []


def changed(record: TrialRecord, change: Callable[[Decision], Decision]) -> TrialRecord:
    """A record with another first decision."""
    first, *rest = record.decisions
    return replace(record, decisions=(replace(first, decision=change(first.decision)), *rest))


def of_chosen(decision: Decision, **values: Any) -> Decision:
    assert decision.chosen is not None
    candidates = list(decision.candidates)
    candidates[decision.chosen] = candidates[decision.chosen]._replace(**values)
    return replace(decision, candidates=tuple(candidates))


def of_subgoal(decision: Decision, **values: Any) -> Decision:
    first, *rest = decision.subgoals
    return replace(decision, subgoals=(replace(first, **values), *rest))


CHOICES: dict[str, Callable[[Decision], Decision]] = {
    'values': lambda one: of_chosen(one, value=-3.5),
    'probabilities': lambda one: of_chosen(one, probability=0.5),
    'more sequences': lambda one: replace(one, sequences=99),
    'a region of its own': lambda one: replace(
        one,
        candidates=(*one.candidates[::-1],),
        chosen=len(one.candidates) - 1 - (one.chosen or 0),
    ),
}


@pytest.mark.parametrize('choice', CHOICES)
def test_its_choices_are_its_own(choice: str) -> None:
    record = changed(of_program('strategy'), CHOICES[choice])
    assert list(contradictions(record)) == []
    ours = replace(record, spec=replace(record.spec, strategy=OWN.strategy))
    assert list(contradictions(ours)) != []


LIES: dict[str, tuple[Callable[[Decision], Decision], str]] = {
    'cells': (lambda one: of_chosen(one, cells=1), 'expected cells'),
    'cancelled': (lambda one: of_chosen(one, status=SolveStatus.CANCELLED), 'was cancelled'),
    'cost': (lambda one: replace(one, subgoal_planning_cost=1), 'subgoal_planning_cost'),
    'sequences': (lambda one: replace(one, sequences=0), 'but only 0 sequences'),
    'index': (lambda one: replace(one, chosen=99), 'out of range'),
    'region': (
        lambda one: of_subgoal(one, region=one.candidates[(one.chosen or 0) - 1].regions[0]),
        'the subgoals differ',
    ),
    'execute': (lambda one: of_subgoal(one, execute=99), 'more placements than its plan'),
    'solution': (lambda one: of_subgoal(one, solution_cost=1 << 40), 'solution_cost is above'),
    'costs': (
        lambda one: of_subgoal(one, planning_cost=one.subgoals[0].planning_cost + 1),
        'do not add up',
    ),
}


@pytest.mark.parametrize('lie', LIES)
def test_everything_else_is_held_to_the_rules(lie: str) -> None:
    change, sentence = LIES[lie]
    said = ' '.join(contradictions(changed(of_program('strategy'), change)))
    assert sentence in said
