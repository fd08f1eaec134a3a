"""A decision that would exceed a limit ends its trial with a code and a sentence."""

from __future__ import annotations

from dataclasses import replace

import pytest
from blocks_planning_msgs import msg as ros
from builders import spec
from part_nodes import WITHOUT_REMINDERS, started
from peers import Bench, Graph

from blocks_planning.ros.nodes import subgoal_selector
from blocks_planning.ros.wire.conversions.decisions import failed_to_ros, subgoal_from_ros
from blocks_planning.ros.wire.conversions.fields import MessageError
from blocks_planning.ros.wire.conversions.trial import ended_to_ros
from blocks_planning.ros.wire.graph import SUBGOAL_SELECTOR
from blocks_planning.subgoals import lookahead
from blocks_planning.subgoals.registry import make_strategy
from blocks_planning.trials import scribe
from blocks_planning.trials.messages import (
    DecisionFailed,
    SearchRequest,
    TrialEnded,
    TrialStarted,
    WorldState,
    observed,
)
from blocks_planning.trials.status import TrialStatus
from blocks_planning.worlds.observation import Observation

FAR = make_strategy('scoping', {'regions': 'rectangles', 'horizon': 3})
TOO_FAR = replace(spec('####/####/####/####'), strategy=FAR, seed=77)
NEAR = spec('####/####/####/####')
WHY = 'horizon 3 with regions rectangles'


def first_state(trial_id: str) -> WorldState:
    return observed(trial_id, NEAR.task.board, (Observation(),), TrialStatus.BUILDING)


def test_selector_says_why_and_goes_on(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """It neither ends nor falls silent: the next trial finds it working."""
    monkeypatch.setattr(lookahead, 'MOST_STATES', 50)
    node = graph.add(subgoal_selector.make_node, **WITHOUT_REMINDERS)
    at = Bench(graph, SUBGOAL_SELECTOR, node, NEAR)
    far = TOO_FAR.trial_id
    at.tell(started(TOO_FAR), first_state(far))
    (failure,) = at.hear(1, DecisionFailed)
    assert failure.trial_id == far
    assert WHY in failure.reason
    at.tell(TrialEnded(far, TrialStatus.CANCELLED, failure.reason))
    at.tell(started(NEAR), first_state(NEAR.trial_id))
    (asked,) = at.hear(1, SearchRequest)
    assert asked.trial_id == NEAR.trial_id
    assert at.peer.only(DecisionFailed) == [failure]


def test_trial_ends_as_failed() -> None:
    memory, _ = scribe.step(scribe.Memory(), TrialStarted('one', TOO_FAR))
    memory, (ended,) = scribe.step(memory, DecisionFailed('one', f'{WHY} is too far'))
    assert isinstance(ended, TrialEnded)
    assert (ended.status, ended.reason) == (TrialStatus.CANCELLED, f'{WHY} is too far')
    outcome = ended_to_ros(None, ended)
    assert outcome.code == ros.TrialOutcome.CODE_FAILED
    assert WHY in outcome.reason


def test_message_is_carried_and_needs_a_reason() -> None:
    failure = DecisionFailed('one', WHY)
    assert subgoal_from_ros(NEAR.task.board, failed_to_ros(failure)) == failure
    with pytest.raises(MessageError, match='reason: expected a sentence'):
        subgoal_from_ros(NEAR.task.board, failed_to_ros(replace(failure, reason='')))
