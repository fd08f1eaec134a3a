"""Node ``subgoal_selector``: which region comes next (none, scoping, full planning, a person).

| | |
|---|---|
| listens | `trial`, `state`, `subgoal/proposal`, `outcome` (latched), `search/result` (stream) |
| says | `search/request` (stream), `subgoal` (latched) |
| parameters | `remind_period_s` |
"""

from __future__ import annotations

from typing import Any

from blocks_planning.ros.graph import SUBGOAL_SELECTOR
from blocks_planning.ros.part_node import PartNode
from blocks_planning.ros.runtime import run
from blocks_planning.trials import selector


def make_node(**options: Any) -> PartNode:
    """The node, not yet spinning."""
    return PartNode(SUBGOAL_SELECTOR, selector, **options)


def main() -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(lambda _: make_node())


if __name__ == '__main__':
    main()
