"""The subgoal planners by name."""

from __future__ import annotations

from collections.abc import Mapping

from blocks_planning.errors import ConfigurationError
from blocks_planning.external import refuse_external
from blocks_planning.families import Registry
from blocks_planning.subgoals.decision import Strategy
from blocks_planning.subgoals.external import ExternalStrategy
from blocks_planning.subgoals.full import FullSubgoals
from blocks_planning.subgoals.human import Human
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.scoping import Scoping

STRATEGIES = Registry(
    'strategy',
    'blocks_planning.strategies',
    (NoSubgoals, Scoping, FullSubgoals, Human, ExternalStrategy),
)


def make_strategy(name: object, values: Mapping[str, object]) -> Strategy:
    """The strategy of a name with some settings; see :meth:`.Registry.make`."""
    strategy: Strategy = STRATEGIES.make(name, values)
    return strategy


def planner_names() -> tuple[str, ...]:
    """The strategies that decide by themselves."""
    return tuple(
        name for name, cls in STRATEGIES.items() if not (cls.asks_person or cls.is_external)
    )


def make_planner(name: object, values: Mapping[str, object]) -> Strategy:
    """A strategy that decides by itself; else as :func:`make_strategy`."""
    strategy = make_strategy(name, values)
    refuse_external(strategy=strategy)
    if strategy.asks_person:
        raise ConfigurationError(
            f'strategy must be one of {", ".join(planner_names())}, got {name!r}: it asks a person'
        )
    return strategy
