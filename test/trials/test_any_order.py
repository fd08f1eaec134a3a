"""All parts together: the record is the same whatever the order of their messages."""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Callable
from functools import cache
from typing import Any

import pytest
from builders import planner_id, spec
from hypothesis import given, settings
from hypothesis import strategies as st
from parts import PARTS, PLANNERS, ROWS, answer, started

from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import (
    Message,
    PlaceBlock,
    PlacementOutcome,
    PlanMade,
    Remind,
    SearchAnswer,
    SearchRequest,
    Solve,
    WorldState,
)
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

undisturbed = cache(run_trial)
"""The record of a trial in which nothing goes wrong."""


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
