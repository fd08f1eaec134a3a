"""Node ``subgoal_selector``: chooses the next region.

| | |
|---|---|
| subscribes | `trial`, `state`, `subgoal/proposal`, `outcome` (latched), `search/result` (stream) |
| publishes | `search/request` (stream), `subgoal` (latched) |
| parameters | `remind_period_s`; `frame_id` |
"""

from __future__ import annotations

from typing import Any

from blocks_planning.ros.runtime.part_node import PartNode
from blocks_planning.ros.runtime.process import run
from blocks_planning.ros.wire.graph import SUBGOAL_SELECTOR
from blocks_planning.trials import selector
from blocks_planning.trials.messages import Message, ProposalMade


class SubgoalSelector(PartNode):
    """The selector; it reports why a proposal is refused."""

    def __init__(self, **options: Any) -> None:
        """See :class:`PartNode`."""
        super().__init__(SUBGOAL_SELECTOR, selector, **options)

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
