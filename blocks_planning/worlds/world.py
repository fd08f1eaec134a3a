"""Worlds by name: what becomes of an order.

A world is part of a trial, beside its strategy and its search. A *simulated* world carries out
orders itself. In an *observed* world somebody else does, such as a robot, and says what is there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Protocol

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed, Placement, format_library
from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.errors import InvalidInput
from blocks_planning.families import Registry
from blocks_planning.settings import Configured
from blocks_planning.worlds.observation import Blocks, Observation


class ImpossibleOrder(InvalidInput):
    """An order that cannot be carried out on the board as it is."""


class World(Protocol):
    """What becomes of orders in a trial; its fields are its settings.

    Attributes:
        simulates: whether :meth:`carry_out` can be called.
    """

    name: ClassVar[str]
    simulates: ClassVar[bool]

    @property
    def obeys(self) -> bool:
        """Whether every possible order is carried out to the letter."""
        ...

    def carry_out(
        self, task: Task, built: Mask, order: Placement, seed: int, sequence: int
    ) -> Observation:
        """Carry out an order. A pure function of its arguments.

        Args:
            task: board and library.
            built: the filled cells.
            order: the placement.
            seed: of the trial.
            sequence: of the observation that follows.

        Raises:
            ImpossibleOrder: if the block is not in the library, or would not come to rest inside
                the board.
        """
        ...

    def complaint(
        self, task: Task, blocks: Blocks, built: Mask, seen: Observation, seed: int, sequence: int
    ) -> str:
        """Why an observation cannot be of this world; '' if it can.

        Args:
            task: board and library.
            blocks: that stood before.
            built: the cells that they fill.
            seen: the observation.
            seed: of the trial.
            sequence: of the observation.
        """
        ...


@dataclass(frozen=True)
class Simulated(Configured):
    """Every possible order is carried out; blocks are glued where they land (paper, "Task")."""

    name: ClassVar[str] = 'simulated'
    simulates: ClassVar[bool] = True

    @property
    def obeys(self) -> bool:
        """Whether every possible order is carried out to the letter."""
        return True

    def carry_out(
        self, task: Task, built: Mask, order: Placement, seed: int, sequence: int
    ) -> Observation:
        """See :class:`World`."""
        return Observation(order, (drop_ordered(task, built, order),))

    def complaint(
        self, task: Task, blocks: Blocks, built: Mask, seen: Observation, seed: int, sequence: int
    ) -> str:
        """See :class:`World`. The outcome is drawn again; it must be equal."""
        if seen.ordered is None:
            return 'the board changed without an order'
        try:
            expected = self.carry_out(task, built, seen.ordered, seed, sequence)
        except ImpossibleOrder as error:
            return str(error)
        return '' if seen == expected else 'the outcome is not what this world draws'


def drop_ordered(task: Task, built: Mask, order: Placement) -> Placed:
    """Where an ordered block comes to rest.

    Raises:
        ImpossibleOrder: if it is not in the library, or would not come to rest inside the board.
    """
    block, column = order
    if block not in task.library:
        raise ImpossibleOrder(
            f'block {block} is not in the library {format_library(task.library)}'
        )
    placed = rules.drop(task.board, built, order)
    if placed is None:
        raise ImpossibleOrder(
            f'block {block} in column {column} does not come to rest inside the board'
        )
    return placed


WORLDS = Registry('world', 'blocks_planning.worlds', (Simulated,))


def make_world(name: object, values: Mapping[str, object]) -> World:
    """The world of a name with some settings; see :meth:`.Registry.make`."""
    world: World = WORLDS.make(name, values)
    return world
