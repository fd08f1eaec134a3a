"""The topics of the graph, in one table that nodes, the recorder and the tests use.

| topic | content | QoS |
|---|---|---|
| `trial` | the running trial | latched |
| `state` | the board, with all observations | latched |
| `search/request`, `search/result` | whether a target can be filled, and the cost | stream |
| `subgoal/proposal` | a region that a person proposes | latched, all |
| `subgoal` | the next subgoal, and all decisions so far | latched |
| `plan` | the placements that will be carried out | latched |
| `action`, `action/outcome` | an order, and its outcome | stream |
| `hold` | the state up to which orders may be given | latched |
| `outcome` | the end of the trial; every node stops working on it | latched |
| `markers` | the tower in three dimensions, for viewers only | latched |

Names are relative: a namespace or a remap moves the whole graph.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from blocks_planning_msgs import msg as ros
from rclpy.qos import QoSProfile
from visualization_msgs.msg import MarkerArray

from blocks_planning.ros.wire import qos
from blocks_planning.ros.wire.conversions import board, decisions, hold, proposals, search, trial
from blocks_planning.trials import messages as core
from blocks_planning.trials.execution import SubgoalChosen


class Topic(NamedTuple):
    """A topic, and the conversion of its messages.

    Attributes:
        name: relative.
        ros_type: of its messages.
        kind: the corresponding message of :mod:`blocks_planning.trials`.
        to_ros: ``to_ros(board, message)``; the board is that of the trial. `trial` and `outcome`
            need no board: it is None.
        from_ros: ``from_ros(board, message)``, its inverse except for headers and explanatory
            sentences.
        latched: whether a node that starts late receives earlier messages.
        depth: number of messages of a latched topic that it receives.
    """

    name: str
    ros_type: type[Any]
    kind: type[Any]
    to_ros: Callable[[Any, Any], Any]
    from_ros: Callable[[Any, Any], Any]
    latched: bool = False
    depth: int = 1

    @property
    def publisher_qos(self) -> QoSProfile:
        """Quality of service of its publishers."""
        return qos.latched_state(self.depth) if self.latched else qos.stream()

    @property
    def subscription_qos(self) -> QoSProfile:
        """Quality of service of its subscriptions."""
        return qos.every_latched_state() if self.latched else qos.stream()


TRIAL = Topic(
    'trial',
    ros.TrialSpec,
    core.TrialStarted,
    trial.started_to_ros,
    trial.started_from_ros,
    latched=True,
)
STATE = Topic(
    'state',
    ros.WorldState,
    core.WorldState,
    board.state_to_ros,
    board.state_from_ros,
    latched=True,
)
SEARCH_REQUEST = Topic(
    'search/request',
    ros.SearchRequest,
    core.SearchRequest,
    search.request_to_ros,
    search.request_from_ros,
)
SEARCH_RESULT = Topic(
    'search/result',
    ros.SearchResult,
    core.SearchAnswer,
    search.answer_to_ros,
    search.answer_from_ros,
)
PROPOSAL = Topic(
    'subgoal/proposal',
    ros.Proposal,
    core.ProposalMade,
    proposals.proposal_to_ros,
    proposals.proposal_from_ros,
    latched=True,
    depth=qos.STREAM_DEPTH,
)
SUBGOAL = Topic(
    'subgoal',
    ros.Subgoal,
    SubgoalChosen,
    decisions.subgoal_to_ros,
    decisions.subgoal_from_ros,
    latched=True,
)
PLAN = Topic(
    'plan', ros.Plan, core.PlanMade, search.plan_to_ros, search.plan_from_ros, latched=True
)
ACTION = Topic(
    'action', ros.PlaceBlock, core.PlaceBlock, board.action_to_ros, board.action_from_ros
)
ACTION_OUTCOME = Topic(
    'action/outcome',
    ros.PlacementOutcome,
    core.PlacementOutcome,
    board.placement_outcome_to_ros,
    board.placement_outcome_from_ros,
)
HOLD = Topic('hold', ros.Hold, core.Held, hold.held_to_ros, hold.held_from_ros, latched=True)
OUTCOME = Topic(
    'outcome',
    ros.TrialOutcome,
    core.TrialEnded,
    trial.ended_to_ros,
    trial.ended_from_ros,
    latched=True,
)

TOPICS = (
    TRIAL,
    STATE,
    SEARCH_REQUEST,
    SEARCH_RESULT,
    PROPOSAL,
    SUBGOAL,
    PLAN,
    ACTION,
    ACTION_OUTCOME,
    HOLD,
    OUTCOME,
)


class ViewTopic(NamedTuple):
    """A latched topic for viewers: no part subscribes to it, and no record depends on it."""

    name: str
    ros_type: type[Any]

    @property
    def publisher_qos(self) -> QoSProfile:
        """Quality of service of its publishers."""
        return qos.latched_state()

    @property
    def subscription_qos(self) -> QoSProfile:
        """Quality of service of subscriptions that must not miss a message."""
        return qos.every_latched_state()


MARKERS = ViewTopic('markers', MarkerArray)

VIEW_TOPICS = (MARKERS,)
