"""Node ``subgoal_selector``: chooses the next region.

| | |
|---|---|
| subscribes | `trial`, `state`, `subgoal/proposal`, `outcome` (latched), `search/result` (stream) |
| publishes | `search/request` (stream), `subgoal` (latched) |
| parameters | `remind_period_s`; `frame_id` |
"""

from __future__ import annotations

from typing import Any

from blocks_planning.errors import LimitExceeded
from blocks_planning.ros.runtime.part_node import PartNode
from blocks_planning.ros.runtime.process import run
from blocks_planning.ros.wire.conversions.decisions import failed_to_ros
from blocks_planning.ros.wire.graph import SUBGOAL_SELECTOR
from blocks_planning.ros.wire.topics import SUBGOAL
from blocks_planning.trials import selector
from blocks_planning.trials.messages import DecisionFailed, Message, ProposalMade, TrialEnded


class SubgoalSelector(PartNode):
    """The selector; it reports why a proposal is refused, and why no decision can be made."""

    def __init__(self, **options: Any) -> None:
        """See :class:`PartNode`."""
        super().__init__(SUBGOAL_SELECTOR, selector, **options)
        self._failed: str | None = None

    def advance(self, message: Message) -> tuple[Message, ...]:
        """See :class:`PartNode`. If a decision exceeds a limit, its trial goes no further here."""
        if isinstance(message, TrialEnded):
            self._failed = None
        elif message.trial_id == self._failed:
            return ()
        try:
            return super().advance(message)
        except LimitExceeded as error:
            self._failed = message.trial_id
            return (DecisionFailed(message.trial_id, str(error)),)

    def perform(self, message: Message) -> None:
        """Publish that no decision can be made."""
        assert isinstance(message, DecisionFailed)
        self.publish(SUBGOAL, failed_to_ros(message))

    def receive(self, message: Message) -> None:
        """See :class:`PartNode`."""
        if isinstance(message, ProposalMade):
            reason = selector.reason_against(self.memory, message.proposal)
            if reason:
                self.refuse('a message on subgoal/proposal', reason)
                return
        super().receive(message)

    def load(self) -> dict[str, object]:
        """See :class:`PartNode`; counts of the queries of the trial."""
        waiting = [query for query in self.memory.asked if query not in self.memory.known]
        chosen = self.memory.chosen
        return {
            'questions_waiting': len(waiting),
            'questions_answered': len(self.memory.known),
            'decisions': 0 if chosen is None else len(chosen.decisions),
        }


def make_node(**options: Any) -> SubgoalSelector:
    """The node, not yet spinning."""
    return SubgoalSelector(**options)


def main() -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(lambda _: make_node())


if __name__ == '__main__':
    main()
