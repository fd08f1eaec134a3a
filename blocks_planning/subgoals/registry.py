"""The subgoal planners by name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from blocks_planning import settings
from blocks_planning.subgoals.decision import Strategy
from blocks_planning.subgoals.full import FullSubgoals
from blocks_planning.subgoals.human import Human
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.scoping import Scoping

PLANNERS: Mapping[str, type[Any]] = {
    strategy.name: strategy for strategy in (NoSubgoals, Scoping, FullSubgoals)
}
"""Those that decide by themselves."""
STRATEGIES: Mapping[str, type[Any]] = {**PLANNERS, Human.name: Human}


def make_strategy(name: object, values: Mapping[str, Any]) -> Strategy:
    """The strategy of a name; see :func:`blocks_planning.settings.make`."""
    strategy: Strategy = settings.make('strategy', STRATEGIES, name, values)
    return strategy


def make_planner(name: object, values: Mapping[str, Any]) -> Strategy:
    """The strategy of a name that needs no person; else as :func:`make_strategy`."""
    planner: Strategy = settings.make('strategy', PLANNERS, name, values)
    return planner
