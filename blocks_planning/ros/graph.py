"""Who listens to what, and who says what."""

from __future__ import annotations

from typing import NamedTuple

from blocks_planning.ros.topics import (
    ACTION,
    ACTION_OUTCOME,
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
)


class NodeTopics(NamedTuple):
    """A node by its name, and its topics."""

    name: str
    listens: tuple[Topic, ...]
    says: tuple[Topic, ...]


WORLD = NodeTopics('world', (TRIAL, ACTION, OUTCOME), (STATE, ACTION_OUTCOME))
SUBGOAL_SELECTOR = NodeTopics(
    'subgoal_selector',
    (TRIAL, STATE, SEARCH_RESULT, PROPOSAL, OUTCOME),
    (SEARCH_REQUEST, SUBGOAL),
)
ACTION_SEARCHER = NodeTopics(
    'action_searcher',
    (TRIAL, STATE, SEARCH_REQUEST, SUBGOAL, OUTCOME),
    (SEARCH_RESULT, PLAN, ACTION),
)
TRIAL_ORCHESTRATOR = NodeTopics('trial_orchestrator', (STATE, SUBGOAL), (TRIAL, OUTCOME))
BAG_RECORDER = NodeTopics('bag_recorder', TOPICS, ())
TRIAL_VIEW = NodeTopics(
    'trial_view',
    (TRIAL, STATE, SEARCH_RESULT, PROPOSAL, SUBGOAL, OUTCOME),
    (PROPOSAL,),
)
WATCHER = NodeTopics('watcher', (TRIAL, STATE, SUBGOAL, OUTCOME), ())

GRAPH = {
    node.name: node
    for node in (
        WORLD,
        SUBGOAL_SELECTOR,
        ACTION_SEARCHER,
        TRIAL_ORCHESTRATOR,
        BAG_RECORDER,
        TRIAL_VIEW,
        WATCHER,
    )
}
