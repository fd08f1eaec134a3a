"""The nodes, and the topics that each subscribes to and publishes."""

from __future__ import annotations

from typing import NamedTuple

from blocks_planning.ros.wire.topics import (
    ACTION,
    ACTION_OUTCOME,
    HOLD,
    MARKERS,
    OUTCOME,
    PLAN,
    PROPOSAL,
    SEARCH_REQUEST,
    SEARCH_RESULT,
    STATE,
    SUBGOAL,
    TOPICS,
    TRIAL,
    Topic,
    ViewTopic,
)


class NodeTopics(NamedTuple):
    """A node by its name, and its topics; ``views`` are its publications for viewers only."""

    name: str
    listens: tuple[Topic, ...]
    says: tuple[Topic, ...]
    views: tuple[ViewTopic, ...] = ()


WORLD = NodeTopics('world', (TRIAL, ACTION, OUTCOME), (STATE, ACTION_OUTCOME))
SUBGOAL_SELECTOR = NodeTopics(
    'subgoal_selector',
    (TRIAL, STATE, SEARCH_RESULT, PROPOSAL, OUTCOME),
    (SEARCH_REQUEST, SUBGOAL),
)
ACTION_SEARCHER = NodeTopics(
    'action_searcher',
    (TRIAL, STATE, SEARCH_REQUEST, SUBGOAL, HOLD, OUTCOME),
    (SEARCH_RESULT, PLAN, ACTION),
)
TRIAL_ORCHESTRATOR = NodeTopics(
    'trial_orchestrator', (STATE, SUBGOAL, ACTION, ACTION_OUTCOME), (TRIAL, HOLD, OUTCOME)
)
BAG_RECORDER = NodeTopics('bag_recorder', TOPICS, ())
MARKER_PUBLISHER = NodeTopics('marker_publisher', (TRIAL, STATE, SUBGOAL, OUTCOME), (), (MARKERS,))
TRIAL_VIEW = NodeTopics(
    'trial_view',
    (TRIAL, STATE, PROPOSAL, SUBGOAL, OUTCOME),
    (PROPOSAL,),
)
ROBOT_ARM = NodeTopics('robot_arm', (TRIAL, OUTCOME), ())
WATCHER = NodeTopics('watcher', (TRIAL, STATE, SUBGOAL, OUTCOME), ())

GRAPH = {
    node.name: node
    for node in (
        WORLD,
        SUBGOAL_SELECTOR,
        ACTION_SEARCHER,
        TRIAL_ORCHESTRATOR,
        BAG_RECORDER,
        MARKER_PUBLISHER,
        TRIAL_VIEW,
        ROBOT_ARM,
        WATCHER,
    )
}

LISTENERS = (BAG_RECORDER.name, MARKER_PUBLISHER.name, TRIAL_VIEW.name, WATCHER.name)
"""Nodes that only record or show: a script waits for them at the start, but no trial ends because
they are missing."""
