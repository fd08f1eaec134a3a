"""Worlds by name: they determine the outcomes of orders.

A world is part of a trial, beside its strategy and its search. A *simulated* world carries out
orders itself. In an *observed* world another system, such as a robot, carries them out and
reports the blocks on the board.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Protocol

from blocks_planning.board import rules, statics
from blocks_planning.board.blocks import Placed, Placement, format_library
from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.errors import InvalidInput
from blocks_planning.families import Registry
from blocks_planning.search.landing import draw_landing
from blocks_planning.settings import Configured, setting
from blocks_planning.worlds.observation import (
    Blocks,
    Observation,
    blocks_after,
    impossible,
    wrong_change,
)


class ImpossibleOrder(InvalidInput):
    """An order that cannot be carried out on the board as it is."""


class World(Protocol):
    """Determines the outcomes of orders in a trial; its fields are its settings.

    Attributes:
        simulates: whether :meth:`carry_out` can be called.
    """

    name: ClassVar[str]
    simulates: ClassVar[bool]

    @property
    def obeys(self) -> bool:
        """Whether every possible order is carried out exactly."""
        ...

    def holds(self, blocks: Blocks) -> bool:
        """Whether a tower of these blocks is stable; if not, the trial ends as collapsed."""
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
        """Why an observation cannot have been made in this world; '' if it can.

        Args:
            task: board and library.
            blocks: that stood before.
            built: the cells that they fill.
            seen: the observation.
            seed: of the trial.
            sequence: of the observation.
        """
        ...


BLOCKS = ('glued', 'loose')
EDGES = ('stands', 'falls')


@dataclass(frozen=True)
class Simulated(Configured):
    """A simulation carries out the orders; blocks may slip or be lost; loose blocks may fall.

    With the default settings every possible order is carried out exactly and blocks are
    glued where they land (paper, section "Task"). With probability ``loss`` an order leaves the
    board as it is; else with probability ``slip`` the block lands one column left or right of the
    order, each with half of that, and as ordered where it cannot land there. ``loose`` blocks are
    judged by statics (:mod:`blocks_planning.board.statics`): a tower that falls ends the trial.
    """

    name: ClassVar[str] = 'simulated'
    simulates: ClassVar[bool] = True
    slip: float = setting(
        0.0,
        'Probability that a block lands one column left or right of its order.',
        least=0,
        most=1,
        unit='probability',
    )
    loss: float = setting(
        0.0, 'Probability that an order places no block.', least=0, most=1, unit='probability'
    )
    blocks: str = setting(
        'glued', 'Whether blocks stay where they land (glued) or can fall (loose).', choices=BLOCKS
    )
    edge: str = setting(
        'stands',
        'Whether a tower of loose blocks at the limit of stability stands or falls.',
        choices=EDGES,
    )

    @property
    def obeys(self) -> bool:
        """Whether every possible order is carried out exactly."""
        return not self.slip and not self.loss and self.blocks == 'glued'

    def holds(self, blocks: Blocks) -> bool:
        """See :class:`World`."""
        return self.blocks == 'glued' or statics.holds(blocks, self.edge == 'stands')

    def carry_out(
        self, task: Task, built: Mask, order: Placement, seed: int, sequence: int
    ) -> Observation:
        """See :class:`World`. The outcome is drawn from (seed, sequence) and nothing else."""
        drop_ordered(task, built, order)
        drawn = draw_landing(task.board, built, order, self.slip, self.loss, seed, sequence)
        return Observation(order, () if drawn.placed is None else (drawn.placed,))

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
        return '' if seen == expected else 'the outcome differs from the one that this world draws'


@dataclass(frozen=True)
class Observed(Configured):
    """Another system (a robot, a physics engine, a person) carries out orders and observes.

    Every observation counts, as long as its blocks can stand on the board.
    """

    name: ClassVar[str] = 'observed'
    simulates: ClassVar[bool] = False

    @property
    def obeys(self) -> bool:
        """False: anything can be observed."""
        return False

    def holds(self, blocks: Blocks) -> bool:
        """See :class:`World`. Observed blocks are stable."""
        return True

    def carry_out(
        self, task: Task, built: Mask, order: Placement, seed: int, sequence: int
    ) -> Observation:
        """See :class:`World`.

        Raises:
            ImpossibleOrder: always.
        """
        raise ImpossibleOrder('world observed does not carry out orders itself')

    def complaint(
        self, task: Task, blocks: Blocks, built: Mask, seen: Observation, seed: int, sequence: int
    ) -> str:
        """See :class:`World`. The blocks must be able to stand where they are observed."""
        return wrong_change(blocks, seen) or impossible(task.board, blocks_after(blocks, seen))


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


WORLDS = Registry('world', 'blocks_planning.worlds', (Simulated, Observed))


def make_world(name: object, values: Mapping[str, object]) -> World:
    """The world of a name with some settings; see :meth:`.Registry.make`."""
    world: World = WORLDS.make(name, values)
    return world
