"""The four parts of a trial, one by one, and together whatever the order of their messages."""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from itertools import pairwise
from types import ModuleType
from typing import Any

import pytest
from builders import (
    ARCH,
    CHAIR,
    EMPTY,
    FRAME,
    NEVER_SOLVED,
    NOTHING_FITS,
    ODD,
    planner_id,
    spec,
)
from hypothesis import given, settings
from hypothesis import strategies as st

from blocks_planning.board.blocks import Block, Placed, Placement
from blocks_planning.search.result import Problem, SolveResult, SolveStatus
from blocks_planning.search.solve import solve
from blocks_planning.subgoals.decision import Query
from blocks_planning.trials import scribe, searcher, selector, world
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import (
    CancelTrial,
    Message,
    PlaceBlock,
    PlacementCode,
    PlacementOutcome,
    PlanMade,
    Remind,
    SearchAnswer,
    SearchRequest,
    Solve,
    TrialEnded,
    TrialStarted,
    WorldState,
    observed,
)
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions
from blocks_planning.worlds.observation import Observation

PARTS = {'world': world, 'selector': selector, 'searcher': searcher, 'scribe': scribe}
TRIAL = spec(CHAIR, lam=0.2, depth=2)
FOREIGN = spec(CHAIR, lam=0.2, depth=2, seed=1)
FULL = spec(CHAIR, strategy='full', depth=1)
PLANNERS: list[dict[str, Any]] = [
    {'strategy': 'scoping', 'lam': 0.2, 'depth': 2},
    {'strategy': 'scoping', 'commit': 'action', 'lam': 0.1, 'depth': 1},
    {'strategy': 'full', 'depth': 1},
    {'strategy': 'none', 'depth': 2},
    {'strategy': 'scoping', 'lam': 0.1, 'horizon': 2, 'choice': 'softmax', 'depth': 1},
]
ROWS = [CHAIR, FRAME, ODD, NEVER_SOLVED, NOTHING_FITS, EMPTY]
TRIALS = [spec(rows, budget=2000, **planner) for rows in ROWS for planner in PLANNERS]
IDS = [f'{rows}-{planner_id(planner)}' for rows in ROWS for planner in PLANNERS]


def tell(
    part: ModuleType, messages: Sequence[Message], memory: Any = None
) -> tuple[Any, list[Message]]:
    """What a part knows, and all that it has said, after some messages."""
    memory = part.Memory() if memory is None else memory
    said: list[Message] = []
    for message in messages:
        memory, more = part.step(memory, message)
        said.extend(more)
    return memory, said


def started(trial: TrialSpec) -> TrialStarted:
    """The message that begins a trial."""
    return TrialStarted(trial.trial_id, trial)


def heard(trial: TrialSpec) -> list[Message]:
    """Every message of an undisturbed trial, in order."""
    messages: list[Message] = []
    run_trial(trial, observe=messages.append)
    return messages


def only(kind: type[Any], messages: list[Message]) -> list[Any]:
    """The messages of a kind."""
    return [message for message in messages if isinstance(message, kind)]


def seen(trial: TrialSpec, *placements: Placed) -> WorldState:
    """The state after some orders that were carried out."""
    found = Observation()
    made = (Observation(placed.placement, (placed,)) for placed in placements)
    return observed(trial.trial_id, trial.task.board, (found, *made), TrialStatus.BUILDING)


undisturbed = cache(run_trial)
"""The record of a trial in which nothing goes wrong."""


@cache
def answer(trial: TrialSpec, query: Query) -> SolveResult:
    """What a solve gives."""
    return solve(Problem(trial.task, *query), trial.search, trial.seed, trial.budget)


START, FOREIGN_START = started(TRIAL), started(FOREIGN)
HEARD = heard(TRIAL)
STATES: list[WorldState] = only(WorldState, HEARD)
CHOSEN: list[SubgoalChosen] = only(SubgoalChosen, HEARD)
ANSWERS: list[SearchAnswer] = only(SearchAnswer, HEARD)


# The world.


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


# What is stale, doubled, foreign, or comes before a trial.


def test_before_a_trial_nobody_says_anything() -> None:
    for part in PARTS.values():
        for message in HEARD[1:]:
            assert part.step(part.Memory(), message) == (part.Memory(), ())


@pytest.mark.parametrize('name', PARTS)
def test_foreign_messages_change_nothing(name: str) -> None:
    part = PARTS[name]
    memory = part.Memory()
    for message in HEARD[:-1]:
        memory, _ = part.step(memory, message)
        for foreign in HEARD[1:]:
            elsewhere = replace(foreign, trial_id=FOREIGN.trial_id)
            assert part.step(memory, elsewhere) == (memory, ())


@pytest.mark.parametrize('name', PARTS)
def test_another_trial_begins_from_nothing(name: str) -> None:
    part = PARTS[name]
    fresh = part.step(part.Memory(), FOREIGN_START)
    for end in range(1, len(HEARD) + 1):
        memory, _ = tell(part, HEARD[:end])
        assert part.step(memory, FOREIGN_START) == fresh


@pytest.mark.parametrize('name', ['world', 'selector', 'searcher'])
def test_after_the_end_nobody_does_anything(name: str) -> None:
    part = PARTS[name]
    memory, _ = tell(part, HEARD)
    assert isinstance(HEARD[-1], TrialEnded)
    for message in HEARD[1:]:
        assert part.step(memory, message) == (memory, ())


# Who asks once more is answered once more.
ANSWERED_AGAIN = {'searcher': (SearchRequest,)}


@pytest.mark.parametrize(
    'trial', [TRIAL, FULL, spec(FRAME, lam=0.05, depth=2)], ids=['scoping', 'full', 'gave up']
)
@pytest.mark.parametrize('name', PARTS)
def test_doubled_and_stale_messages_change_nothing(name: str, trial: TrialSpec) -> None:
    part = PARTS[name]
    memory = part.Memory()
    past: list[Message] = []
    for message in heard(trial):
        memory, _ = part.step(memory, message)
        past.append(message)
        for old in past[isinstance(message, TrialEnded) :]:
            after, said = part.step(memory, old)
            assert after == memory, (message, old)
            if not isinstance(old, ANSWERED_AGAIN.get(name, ())):
                assert said == (), (message, old)


@pytest.mark.parametrize('name', ['selector', 'searcher', 'scribe'])
def test_a_state_of_the_past_is_ignored(name: str) -> None:
    part = PARTS[name]
    memory, _ = tell(part, [START, STATES[3]])
    for old in STATES[:4]:
        assert part.step(memory, old) == (memory, ())


def test_placement_for_another_state_is_ignored() -> None:
    memory, _ = tell(world, [START])
    for sequence in (-1, 1, 2):
        stale = PlaceBlock(TRIAL.trial_id, sequence, Placement(Block(1, 2), 0))
        assert world.step(memory, stale) == (memory, ())


def test_answer_that_was_not_asked_for_is_no_reason_to_decide() -> None:
    for length in (1, 2):
        memory, _ = tell(selector, HEARD[:length])
        unasked = SearchAnswer(TRIAL.trial_id, Query(0b1, 0b11), SolveResult(SolveStatus.SOLVED))
        assert selector.step(memory, unasked) == (memory, ())


# The selector.


def test_selector_asks_about_every_candidate_and_then_decides() -> None:
    memory, requests = tell(selector, [START, STATES[0]])
    task = TRIAL.task
    queries = tuple(Query(0, task.rows(height)) for height in range(1, 7))
    assert requests == [SearchRequest(TRIAL.trial_id, queries)]
    for query in queries[:0:-1]:
        memory, said = tell(
            selector, [SearchAnswer(TRIAL.trial_id, query, answer(TRIAL, query))], memory
        )
        assert said == []
    last = SearchAnswer(TRIAL.trial_id, queries[0], answer(TRIAL, queries[0]))
    _, said = tell(selector, [last], memory)
    assert said == [CHOSEN[0]]


def test_selector_says_nothing_while_a_subgoal_is_executed() -> None:
    memory, _ = tell(selector, HEARD[: HEARD.index(CHOSEN[0])])
    assert memory.chosen == CHOSEN[0]
    execute = CHOSEN[1].sequence
    assert execute > 1
    memory, said = tell(selector, [*STATES[1:execute]], memory)
    assert said == []
    _, said = tell(selector, [STATES[execute]], memory)
    assert said
    assert all(isinstance(message, SearchRequest) for message in said)


def test_selector_decides_anew_where_a_plan_was_left() -> None:
    memory, _ = tell(selector, HEARD[: HEARD.index(CHOSEN[0])])
    elsewhere = seen(TRIAL, Placed(1, 2, 1, 0))
    after, said = tell(selector, [elsewhere], memory)
    # It covers cells that are no target: no region contains them.
    assert after.chosen is not None
    [chosen] = only(SubgoalChosen, said)
    assert chosen.subgoal is None
    assert chosen.sequence == 1


def test_selector_goes_on_to_the_next_subgoal_of_a_sequence() -> None:
    chosen: list[SubgoalChosen] = only(SubgoalChosen, heard(FULL))
    assert [message.index for message in chosen] == list(range(len(chosen)))
    assert len(chosen) > 2
    assert {len(message.decisions) for message in chosen} == {1}
    for before, after in pairwise(chosen):
        assert before.subgoal is not None
        assert before.subgoal.target == after.built
        assert after.sequence == before.sequence + before.subgoal.execute


@pytest.mark.parametrize('trial', TRIALS, ids=IDS)
def test_selector_that_has_forgotten_everything_asks_again(trial: TrialSpec) -> None:
    messages = heard(trial)
    chosen = only(SubgoalChosen, messages)
    for state in only(WorldState, messages):
        memory, said = tell(selector, [started(trial), state])
        announced = only(SubgoalChosen, said)
        while requests := only(SearchRequest, said):
            answers = [
                SearchAnswer(trial.trial_id, query, answer(trial, query))
                for request in requests
                for query in request.queries
            ]
            memory, said = tell(selector, list(answers), memory)
            announced += only(SubgoalChosen, said)
        over = state.status is not TrialStatus.BUILDING
        latest = [message for message in chosen if message.sequence <= state.sequence - over]
        assert announced == latest[-1:]
        assert memory.chosen == (latest[-1] if latest else None)


def test_selector_that_is_reminded_asks_what_is_unanswered() -> None:
    memory, requests = tell(selector, [START, STATES[0]])
    memory, _ = tell(selector, ANSWERS[:2], memory)
    [request] = only(SearchRequest, requests)
    rest = SearchRequest(TRIAL.trial_id, request.queries[2:])
    assert selector.step(memory, Remind(TRIAL.trial_id)) == (memory, (rest,))


# The searcher.


def test_searcher_solves_what_is_asked_once() -> None:
    query = ANSWERS[0].query
    request = SearchRequest(TRIAL.trial_id, (query,))
    memory, said = tell(searcher, [START, request])
    assert said == [Solve(TRIAL.trial_id, query)]
    memory, said = tell(searcher, [ANSWERS[0]], memory)
    assert said == []
    _, said = tell(searcher, [request], memory)
    assert said == [ANSWERS[0]]


def test_searcher_solves_no_query_twice_at_a_time() -> None:
    request = SearchRequest(TRIAL.trial_id, (ANSWERS[0].query,))
    _, said = tell(searcher, [START, request, request])
    assert said == [Solve(TRIAL.trial_id, ANSWERS[0].query)]


def test_searcher_sends_one_placement_for_each_state() -> None:
    memory, sent = tell(searcher, [START, STATES[0], *ANSWERS[:6], CHOSEN[0]])
    plan = CHOSEN[0].subgoal
    assert plan is not None
    for state in STATES[1 : plan.execute + 1]:
        memory, said = tell(searcher, [state], memory)
        sent += said
    assert sent == [
        PlanMade(TRIAL.trial_id, 0, plan.target, plan.execute, plan.placements),
        *(
            PlaceBlock(TRIAL.trial_id, number, placed.placement)
            for number, placed in enumerate(plan.placements)
        ),
    ]
    assert only(PlaceBlock, HEARD)[: len(sent) - 1] == sent[1:]


@pytest.mark.parametrize('order', ['state first', 'subgoal first'])
@pytest.mark.parametrize('trial', TRIALS, ids=IDS)
def test_searcher_that_has_forgotten_everything_goes_on(trial: TrialSpec, order: str) -> None:
    messages = heard(trial)
    chosen = only(SubgoalChosen, messages)
    placed = {message.sequence: message for message in only(PlaceBlock, messages)}
    for state in only(WorldState, messages):
        if state.sequence not in placed:
            continue
        latest = [message for message in chosen if message.sequence <= state.sequence][-1]
        latched = [state, latest] if order == 'state first' else [latest, state]
        memory, said = tell(searcher, [started(trial), *latched])
        query = Query(latest.built, latest.subgoal.target)
        assert said == [Solve(trial.trial_id, query)]
        result = SearchAnswer(trial.trial_id, query, answer(trial, query))
        _, said = tell(searcher, [result], memory)
        assert only(PlaceBlock, said) == [placed[state.sequence]]
        assert [message.sequence for message in only(PlanMade, said)] == [latest.sequence]


def test_searcher_that_is_reminded_sends_its_placement_again() -> None:
    memory, said = tell(searcher, [START, STATES[0], *ANSWERS[:6], CHOSEN[0]])
    assert searcher.step(memory, Remind(TRIAL.trial_id)) == (memory, tuple(only(PlaceBlock, said)))


def test_searcher_places_nothing_where_no_subgoal_leads_on() -> None:
    memory, _ = tell(searcher, [START, *ANSWERS[:6], CHOSEN[0]])
    for state in STATES[CHOSEN[1].sequence :]:
        _, said = tell(searcher, [state], memory)
        assert only(PlaceBlock, said) == []
    _, said = tell(searcher, [seen(TRIAL, Placed(1, 2, 1, 0))], memory)
    assert only(PlaceBlock, said) == []


def test_searcher_does_nothing_when_the_planner_gives_up() -> None:
    messages = heard(spec(NEVER_SOLVED))
    assert only(SubgoalChosen, messages)[0].subgoal is None
    assert only(PlaceBlock, messages) == []


# The scribe.


def test_scribe_writes_down_and_ends() -> None:
    memory, said = tell(scribe, HEARD)
    assert said == [TrialEnded(TRIAL.trial_id, TrialStatus.SUCCESS, '', run_trial(TRIAL))]
    assert memory.record() == run_trial(TRIAL)


def test_scribe_has_no_record_before_a_trial() -> None:
    with pytest.raises(ValueError, match='no record before a trial'):
        scribe.Memory().record()


def test_scribe_ends_a_trial_that_the_world_can_not_go_on_with() -> None:
    """With what the world says, and only on the state that it says it of."""
    memory, _ = tell(scribe, [HEARD[0], STATES[0], CHOSEN[0], STATES[1]])
    failed = PlacementOutcome(TRIAL.trial_id, 1, None, 'the arm is broken', PlacementCode.FAILED)
    for stale in (replace(failed, sequence=0), replace(failed, sequence=2)):
        assert scribe.step(memory, stale) == (memory, ())
    assert scribe.step(memory, replace(failed, code=PlacementCode.IMPOSSIBLE)) == (memory, ())
    memory, said = scribe.step(memory, failed)
    record = memory.record()
    assert (record.status, record.reason) == (TrialStatus.CANCELLED, 'the arm is broken')
    assert said == (TrialEnded(TRIAL.trial_id, record.status, record.reason, record),)
    assert memory.record().placements == STATES[1].placements


def test_record_of_a_cancelled_trial_is_cut_where_something_was_on_its_way() -> None:
    for state in STATES:
        for count in range(len(CHOSEN) + 1):
            memory, _ = tell(scribe, [HEARD[0], state, *CHOSEN[:count]])
            memory, _ = scribe.step(memory, CancelTrial(TRIAL.trial_id, 'why'))
            assert list(contradictions(memory.record())) == []


def test_scribe_says_the_usual_sentence_of_a_failure_without_one() -> None:
    memory, _ = tell(scribe, [HEARD[0], STATES[0]])
    failed = PlacementOutcome(TRIAL.trial_id, 0, None, '', PlacementCode.FAILED)
    memory, _ = scribe.step(memory, failed)
    assert memory.record().reason == 'no block can be placed any more'


def test_world_is_restored_by_placements_that_can_be_only() -> None:
    memory, _ = tell(world, [HEARD[0]])
    assert isinstance(memory, world.Memory)
    for state in STATES:
        restored = world.restored(memory, state.observations)
        assert restored is not None
        assert restored.state == state
    found, first, *rest = STATES[-1].observations
    (placed,) = first.landed
    moved = first._replace(landed=(placed._replace(row=placed.row + 1),))
    assert world.restored(memory, (found, moved, *rest)) is None
    assert world.restored(memory, (found, first, Observation(None, (placed,)))) is None
    assert world.restored(memory, (first,)) is None


def test_scribe_ends_a_cancelled_trial_as_it_stands() -> None:
    for length in range(1, len(HEARD) - 1):
        memory, before = tell(scribe, HEARD[:length])
        memory, said = tell(scribe, [CancelTrial(TRIAL.trial_id)], memory)
        if before:
            assert said == []
            continue
        record = memory.record()
        assert said == [TrialEnded(TRIAL.trial_id, TrialStatus.CANCELLED, '', record)]
        assert record.status is TrialStatus.CANCELLED
        assert list(contradictions(record)) == []
        for message in HEARD[length:]:
            assert scribe.step(memory, message) == (memory, ())


@pytest.mark.parametrize('order', ['state first', 'subgoal first'])
@pytest.mark.parametrize('trial', TRIALS, ids=IDS)
def test_scribe_that_missed_everything_but_the_end_knows_all(trial: TrialSpec, order: str) -> None:
    messages = heard(trial)
    latched = [*only(WorldState, messages)[-1:], *only(SubgoalChosen, messages)[-1:]]
    if order == 'subgoal first':
        latched.reverse()
    memory, said = tell(scribe, [started(trial), *latched])
    assert memory.record() == run_trial(trial)
    assert len(said) == 1


# All together, whatever the order.


def _sender(message: Message) -> str:
    """The part that says a message."""
    match message:
        case WorldState() | PlacementOutcome():
            return 'world'
        case SearchRequest() | SubgoalChosen():
            return 'selector'
        case SearchAnswer() | PlaceBlock() | Solve() | PlanMade():
            return 'searcher'
    return 'scribe'


Link = tuple[str, str]


class Network:
    """Carries messages between the parts: a queue from every part to every part."""

    def __init__(self, trial: TrialSpec, times: int = 1) -> None:
        """Begin a trial in which every message is delivered so many times."""
        self.trial = trial
        self.times = times
        self.memories: dict[str, Any] = {}
        self.links: dict[Link, deque[Message]] = {}
        for name, part in PARTS.items():
            self.memories[name] = part.Memory()
            self.deliver(name, started(trial))

    def deliver(self, name: str, message: Message) -> None:
        """Hand a message to a part, and send what it says."""
        self.memories[name], said = PARTS[name].step(self.memories[name], message)
        for more in said:
            if isinstance(more, Solve):  # the searcher's own affair
                more = SearchAnswer(more.trial_id, more.query, answer(self.trial, more.query))
            for receiver in PARTS:
                link = self.links.setdefault((_sender(more), receiver), deque())
                link.extend([more] * self.times)

    def run(
        self,
        choose: Callable[[list[Link]], Link],
        lost: Callable[[], bool] = lambda: False,
    ) -> TrialRecord:
        """Deliver one message after the other, or lose it, until there are none."""
        while busy := sorted(link for link, waiting in self.links.items() if waiting):
            link = choose(busy)
            message = self.links[link].popleft()
            if not (isinstance(message, CAN_BE_LOST) and link[0] != link[1] and lost()):
                self.deliver(link[1], message)
        record: TrialRecord = self.memories['scribe'].record()
        return record


# States and subgoals are kept for whoever comes late.
CAN_BE_LOST = (SearchRequest, SearchAnswer, PlaceBlock, PlacementOutcome, PlanMade)


@pytest.mark.parametrize('planner', PLANNERS, ids=planner_id)
@pytest.mark.parametrize('rows', ROWS)
def test_messages_that_are_delivered_twice_change_no_record(
    rows: str, planner: dict[str, Any]
) -> None:
    trial = spec(rows, budget=2000, **planner)
    assert Network(trial, 2).run(lambda links: links[0]) == undisturbed(trial)


@pytest.mark.parametrize('first', PARTS)
@pytest.mark.parametrize('planner', PLANNERS, ids=planner_id)
def test_record_is_the_same_whoever_is_fastest(planner: dict[str, Any], first: str) -> None:
    for rows in ROWS:
        trial = spec(rows, budget=2000, **planner)
        expected = undisturbed(trial)
        assert (
            Network(trial, 1).run(lambda links: max(links, key=lambda link: link[1] == first))
            == expected
        )
        assert (
            Network(trial, 1).run(lambda links: min(links, key=lambda link: link[1] == first))
            == expected
        )


@pytest.mark.parametrize('planner', PLANNERS, ids=planner_id)
@given(data=st.data())
def test_record_is_the_same_in_any_interleaving(
    planner: dict[str, Any], data: st.DataObject
) -> None:
    trial = spec(data.draw(st.sampled_from(ROWS)), budget=2000, **planner)
    network = Network(trial, data.draw(st.integers(1, 2)))
    order = random.Random(data.draw(st.integers(0, 2**32)))
    assert network.run(order.choice) == undisturbed(trial)


@pytest.mark.parametrize('planner', PLANNERS, ids=planner_id)
@given(seed=st.integers(0, 2**32))
@settings(max_examples=30)
def test_record_is_the_same_if_messages_are_lost(planner: dict[str, Any], seed: int) -> None:
    source = random.Random(seed)
    for rows in ROWS:
        trial = spec(rows, budget=2000, **planner)
        network = Network(trial)
        record = network.run(source.choice, lambda: source.random() < 0.3)
        reminders = 0
        while record.status is TrialStatus.BUILDING:
            reminders += 1
            assert reminders < 1000, 'it does not go on'
            for name in PARTS:
                network.deliver(name, Remind(trial.trial_id))
            record = network.run(source.choice, lambda: source.random() < 0.3)
        assert record == undisturbed(trial)
