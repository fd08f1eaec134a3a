"""The nodes of the parts of a trial, and what is said in one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from builders import CHAIR, spec
from peers import Bench, Graph
from rclpy.parameter import Parameter

from blocks_planning.ros.nodes import subgoal_selector, world
from blocks_planning.ros.nodes.action_searcher import ActionSearcher
from blocks_planning.ros.wire.graph import ACTION_SEARCHER, SUBGOAL_SELECTOR, WORLD, NodeTopics
from blocks_planning.ros.wire.topics import OUTCOME
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message, SearchAnswer, SearchRequest, TrialStarted
from blocks_planning.trials.spec import TrialSpec

TRIAL_SPEC = spec(CHAIR, lam=0.2, depth=2)
FOREIGN = spec(CHAIR, lam=0.2, depth=2, seed=1)
HEARD: list[Message] = []
RECORD = run_trial(TRIAL_SPEC, observe=HEARD.append)
FIRST_ASKED = [
    m
    for m in HEARD
    if isinstance(m, SearchRequest) and all(query.built == 0 for query in m.queries)
]
PARTS: list[tuple[NodeTopics, Callable[..., Any]]] = [
    (WORLD, world.make_node),
    (SUBGOAL_SELECTOR, subgoal_selector.make_node),
    (ACTION_SEARCHER, ActionSearcher),
]
PART_IDS = [topics.name for topics, _ in PARTS]
WITHOUT_REMINDERS = {'parameter_overrides': [Parameter('remind_period_s', value=3600.0)]}
each_part = pytest.mark.parametrize(('topics', 'make_node'), PARTS, ids=PART_IDS)


def started(trial: TrialSpec) -> TrialStarted:
    """The message that begins a trial."""
    return TrialStarted(trial.trial_id, trial)


def foreign(message: Message) -> Message:
    """The same, said about another trial."""
    return replace(message, trial_id=FOREIGN.trial_id)


def bench(graph: Graph, topics: NodeTopics, make_node: Callable[..., Any]) -> Bench:
    """A node that does not remind by itself, with its peer."""
    return Bench(graph, topics, graph.add(make_node, **WITHOUT_REMINDERS), TRIAL_SPEC)


def for_node(topics: NodeTopics) -> list[Message]:
    """What a node hears of an undisturbed trial, but its end."""
    kinds = tuple(topic.kind for topic in topics.listens if topic is not OUTCOME)
    return [message for message in HEARD if isinstance(message, kinds)]


def of_node(topics: NodeTopics) -> list[Message]:
    """What a node says in an undisturbed trial."""
    kinds = tuple(topic.kind for topic in topics.says)
    return [message for message in HEARD if isinstance(message, kinds)]


def by_topic(messages: list[Message]) -> dict[type, list[Message]]:
    """Messages by kind. Topics are not ordered among each other, and answers may overtake."""
    found: dict[type, list[Message]] = {}
    for message in messages:
        found.setdefault(type(message), []).append(message)
    found.get(SearchAnswer, []).sort(key=str)
    return found
