"""Worlds that somebody else observes: drivers of one's own, well behaved or not."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

from peers import Peer

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed
from blocks_planning.ros.wire.graph import WORLD
from blocks_planning.ros.wire.topics import STATE, Topic
from blocks_planning.trials.messages import (
    PlaceBlock,
    PlacementCode,
    PlacementOutcome,
    TrialEnded,
    TrialStarted,
    WorldState,
    observed,
)
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.worlds.observation import Observation


class Driver(Peer):
    """Carries out every order to the letter, unless it is told what else to do with one.

    Attributes:
        seen: what it has observed.
        is_stuck: whether it will say nothing new any more.
        ended: the outcome of the trial.
    """

    def __init__(self, spec: TrialSpec, act: Act | None = None, **options: Any) -> None:
        """Take a trial; ``act`` carries out an order on the latest state, and says so."""
        super().__init__(spec, WORLD.says, WORLD.listens, name='driver', **options)
        self.spec = spec
        self.act = act or obey
        self.seen: tuple[Observation, ...] = ()
        self.is_stuck = False
        self.ended: TrialEnded | None = None
        self._repeating: Any = None
        self.create_timer(0.02, self._repeat)

    @property
    def state(self) -> WorldState:
        """The latest state."""
        spec = self.spec
        state = observed(spec.trial_id, spec.task.board, self.seen, TrialStatus.BUILDING)
        if state.built != spec.task.silhouette:
            return state
        return observed(spec.trial_id, spec.task.board, self.seen, TrialStatus.SUCCESS)

    def landing(self, order: PlaceBlock) -> Placed:
        """Where an ordered block comes to rest."""
        placed = rules.drop(self.spec.task.board, self.state.built, order.placement)
        assert placed is not None
        return placed

    def observe(self, *observations: Observation) -> None:
        """Observe something, and publish the state."""
        self.seen += observations
        self.say(self.state)

    def tell(self, order: PlaceBlock, code: PlacementCode, **fields: Any) -> None:
        """Say what became of an order."""
        fields = {'placed': None, **fields}
        self.say(PlacementOutcome(order.trial_id, order.sequence, code=code, **fields))

    def repeat(self, state: Any) -> None:
        """Publish a message on `state` again and again until the trial ends."""
        self._repeating = state
        self.is_stuck = True

    def _repeat(self) -> None:
        if self._repeating is not None and self.ended is None:
            self.outlets[STATE].publish(self._repeating)

    def _hear(self, topic: Topic, message: Any) -> None:
        super()._hear(topic, message)
        heard = self.heard[-1]
        match heard:
            case TrialStarted() if not self.seen:
                self.observe(Observation())
            case PlaceBlock(sequence=sequence) if sequence == len(self.seen) - 1:
                self.act(self, heard)
            case TrialEnded():
                self.ended = heard


Act: TypeAlias = Callable[[Driver, PlaceBlock], None]


def obey(driver: Driver, order: PlaceBlock) -> None:
    """Carry out an order to the letter."""
    placed = driver.landing(order)
    driver.tell(order, PlacementCode.PLACED, placed=placed)
    driver.observe(Observation(order.placement, (placed,)))
