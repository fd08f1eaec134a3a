"""A person's subgoals, by hand on a board of 3 x 3."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from builders import task
from persons import BUILD, GIVE_UP, WITHDRAWN

from blocks_planning.board.blocks import Block, Placed
from blocks_planning.errors import ConfigurationError
from blocks_planning.search.result import SolveResult, SolveStatus
from blocks_planning.subgoals.decision import Candidate, Decision, Query, Situation
from blocks_planning.subgoals.human import Human, used
from blocks_planning.subgoals.proposals import Proposal, ProposalKind, target_of
from blocks_planning.subgoals.regions import Label, Region, drawn_region, rows_label
from blocks_planning.subgoals.registry import (
    STRATEGIES,
    make_planner,
    make_strategy,
    planner_names,
)

# Two columns of two cells; the one in the middle stays empty.
TASK = task('.../#.#/#.#', '1x1,1x2')
LEFT, RIGHT, BOTTOM = (
    TASK.board.parse(rows)
    for rows in (['...', '#..', '#..'], ['...', '..#', '..#'], ['...', '...', '###'])
)
DRAWN = Region(Label('drawn'), LEFT)
SOLVED = SolveResult(
    SolveStatus.SOLVED, (Placed(*Block(1, 2), 0, 0),), planning_cost=7, solution_cost=3, attempts=2
)
UNSOLVED = SolveResult(SolveStatus.BUDGET_EXHAUSTED, (), planning_cost=50, attempts=9)


def said(*words: tuple[ProposalKind, int]) -> tuple[Proposal, ...]:
    """What a person said in the empty state."""
    return tuple(
        Proposal(0, number, kind, region, 1.5) for number, (kind, region) in enumerate(words)
    )


def situation(
    known: dict[Query, SolveResult], proposals: tuple[Proposal, ...], built: int = 0
) -> Situation:
    return Situation(TASK, built, 0, known, proposals)


def decide(known: dict[Query, SolveResult], *words: tuple[ProposalKind, int]) -> Any:
    return Human().decide(situation(known, said(*words)))


def test_waits_for_the_person() -> None:
    assert decide({}) == []
    assert decide({}, (WITHDRAWN, LEFT)) == []
    assert decide({}, (BUILD, TASK.board.parse(['###', '...', '...']))) == []


def test_asks_what_filling_the_region_takes() -> None:
    """Of what was drawn the cells of the silhouette are meant, with what is built."""
    assert decide({}, (BUILD, LEFT)) == [Query(0, LEFT)]
    drawn = TASK.board.parse(['##.', '##.', '##.'])
    assert decide({}, (WITHDRAWN, RIGHT), (BUILD, drawn)) == [Query(0, LEFT)]
    assert Human().decide(situation({}, said((BUILD, RIGHT)), LEFT)) == [
        Query(LEFT, TASK.silhouette)
    ]


def test_follows_the_person_when_it_can_be_built() -> None:
    decision = decide({Query(0, LEFT): SOLVED}, (BUILD, LEFT), (GIVE_UP, 0))
    assert decision.candidates == (Candidate((DRAWN,), 2, 7, None, SolveStatus.SOLVED),)
    assert decision.chosen == 0
    assert decision.subgoal_planning_cost == 7
    (subgoal,) = decision.subgoals
    assert (subgoal.region, subgoal.target, subgoal.execute) == (DRAWN, LEFT, 1)
    assert (subgoal.planning_cost, subgoal.solution_cost, subgoal.attempts) == (7, 3, 2)


def test_what_can_not_be_built_costs_and_the_person_goes_on() -> None:
    known = {Query(0, RIGHT): UNSOLVED}
    assert decide(known, (BUILD, RIGHT)) == []
    assert decide(known, (BUILD, RIGHT), (BUILD, LEFT)) == [Query(0, LEFT)]
    known[Query(0, LEFT)] = SOLVED
    decision = decide(known, (BUILD, RIGHT), (WITHDRAWN, BOTTOM), (BUILD, RIGHT), (BUILD, LEFT))
    assert [c.status.value for c in decision.candidates] == [
        'budget_exhausted',
        'budget_exhausted',
        'solved',
    ]
    assert decision.chosen == 2
    assert decision.subgoal_planning_cost == 50 + 50 + 7


def test_giving_up_ends_it() -> None:
    known = {Query(0, RIGHT): UNSOLVED}
    decision = decide(known, (BUILD, RIGHT), (GIVE_UP, 0), (BUILD, LEFT))
    assert (decision.chosen, decision.subgoals) == (None, ())
    assert len(decision.candidates) == 1
    assert decision.subgoal_planning_cost == 50


def test_rows_are_known_by_their_height() -> None:
    rows = TASK.rows(1)
    assert drawn_region(TASK, 0, BOTTOM) == Region(rows_label(1), rows)
    # Of heights 2 and 3, whose rows are the same, the lower is named.
    assert drawn_region(TASK, LEFT, RIGHT) == Region(rows_label(2), TASK.silhouette)
    assert drawn_region(TASK, 0, LEFT) == DRAWN
    decision = decide({Query(0, rows): SOLVED}, (BUILD, BOTTOM))
    assert decision.candidates[0].regions == (Region(rows_label(1), rows),)
    assert decision.subgoals[0].region.label == rows_label(1)


def test_used_are_those_up_to_the_one_that_decided() -> None:
    words = said((BUILD, RIGHT), (WITHDRAWN, 0), (BUILD, LEFT), (BUILD, RIGHT), (GIVE_UP, 0))
    known = {Query(0, RIGHT): UNSOLVED, Query(0, LEFT): SOLVED}
    decision = Human().decide(situation(known, words))
    assert isinstance(decision, Decision)
    assert used(situation(known, words), decision) == words[:3]
    ended = situation({Query(0, RIGHT): UNSOLVED}, said((BUILD, RIGHT), (GIVE_UP, 0)))
    gave_up = Human().decide(ended)
    assert isinstance(gave_up, Decision)
    more = said((BUILD, RIGHT), (GIVE_UP, 0), (BUILD, LEFT))
    assert len(used(replace(ended, proposals=more), gave_up)) == 2


def test_target_has_what_is_built_and_nothing_off_the_silhouette() -> None:
    assert target_of(TASK, LEFT, TASK.board.full) == TASK.silhouette
    assert target_of(TASK, LEFT, LEFT) == LEFT
    assert target_of(TASK, 0, 0) == 0


@pytest.mark.parametrize(
    ('values', 'what'),
    [
        ({'participant': 'Jane Doe'}, "participant must be a code .*, got 'Jane Doe'"),
        ({'participant': 'x' * 33}, 'participant must be a code of up to 32'),
        ({'participant': 7}, 'participant must be a code .*, got 7'),
        ({'costs': 'some'}, "costs must be one of shown, hidden, got 'some'"),
        ({'lambda': 1.0}, "strategy human has no setting 'lambda'"),
    ],
)
def test_settings_that_can_not_be_are_refused(values: dict[str, Any], what: str) -> None:
    with pytest.raises(ConfigurationError, match=what):
        make_strategy('human', values)


@pytest.mark.parametrize('thinking_s', [-0.1, float('nan'), float('inf')])
def test_time_that_can_not_be_is_refused(thinking_s: float) -> None:
    with pytest.raises(ConfigurationError, match='thinking_s must be a finite number'):
        Proposal(0, 0, BUILD, 1, thinking_s)


def test_where_nobody_can_be_asked_only_planners_will_do() -> None:
    assert set(STRATEGIES) - set(planner_names()) == {'human', 'external'}
    with pytest.raises(
        ConfigurationError, match=rf'one of {", ".join(planner_names())}, got .human'
    ):
        make_planner('human', {})
