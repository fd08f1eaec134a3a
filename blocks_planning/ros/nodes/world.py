"""Node ``world``: owns the board and carries out orders.

The driver of real hardware can replace this node without other changes. With a ``journal_dir`` a
world that was killed and restarted continues with the board of the running trial. If an observation
cannot be written to disk, the order is not executed; the trial ends, and its outcome has the
reason. While an order takes longer than a second, the world reports that every second.

In a trial of world `observed` it asks an arm, by the action `place`, to carry out each order. What
the arm reports is the state of the board.

| | |
|---|---|
| subscribes | `trial`, `outcome` (latched), `action` (stream) |
| publishes | `state` (latched), `action/outcome` (stream) |
| asks | action `place`, in trials of world `observed` |
| parameters | `remind_period_s`; `frame_id`; `journal_dir`: folder of the journal; `placing_s`: duration of a placement; `cell_size`: side of a cell, for an arm |
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from blocks_planning.errors import RecordError
from blocks_planning.ros.runtime.arm import Arm
from blocks_planning.ros.runtime.guarded import WARN_PERIOD_S
from blocks_planning.ros.runtime.journal import Journal
from blocks_planning.ros.runtime.parameters import Parameter
from blocks_planning.ros.runtime.part_node import PartNode
from blocks_planning.ros.runtime.process import run
from blocks_planning.ros.wire.graph import WORLD
from blocks_planning.trials import world
from blocks_planning.trials.messages import (
    ArmOrder,
    ArmReport,
    Message,
    PlaceBlock,
    PlacementCode,
    PlacementOutcome,
    TrialEnded,
    TrialStarted,
    WorldState,
)

JOURNAL_DIR = Parameter('journal_dir', '', 'Folder of the journal; none: no journal.')
PLACING = Parameter('placing_s', 0.0, 'Duration of a placement [s].', (0.0, 3600.0))
CELL_SIZE = Parameter('cell_size', 0.05, 'Side of a cell, for an arm [m].', (1e-6, 1e3))
NEWS_PERIOD_S = 1.0


class World(PartNode):
    """The world, with a journal."""

    def __init__(self, **options: Any) -> None:
        """See :class:`PartNode`.

        Raises:
            RecordError: if the journal cannot be written in its folder.
        """
        super().__init__(WORLD, world, (JOURNAL_DIR, PLACING, CELL_SIZE), **options)
        folder = self.values['journal_dir']
        self._journal = Journal(Path(folder)) if folder else None
        self._lost = ''
        self._placing: PlaceBlock | None = None
        self._placed = self.create_timer(
            max(self.values['placing_s'], 1e-3), self._place, clock=self.steady
        )
        self._placed.cancel()
        self._began_s = 0.0
        self._news = self.create_timer(NEWS_PERIOD_S, self._tell_progress, clock=self.steady)
        self._news.cancel()
        self._arm: Arm | None = None

    def advance(self, message: Message) -> tuple[Message, ...]:
        """See :class:`PartNode`; an observation is in the journal before it is published."""
        before = self.memory
        said = super().advance(message)
        if self._journal is None:
            return said
        match message:
            case TrialStarted() if said:
                return self._resume(self._journal, message.trial_id)
            case PlaceBlock() | ArmReport() if said:
                try:
                    for state in (answer for answer in said if isinstance(answer, WorldState)):
                        self._journal.append(state.observations[-1])
                except RecordError as error:
                    self.memory = before
                    return self._failure(message, str(error))
            case PlaceBlock() if self._lost and before.state is not None:
                if message.sequence > before.state.sequence:
                    return self._failure(message, self._lost)
            case TrialEnded():
                self._lost = ''
                self._journal.end()
        return said

    def _resume(self, journal: Journal, trial_id: str) -> tuple[Message, ...]:
        """Continue a trial from its journal; or from its initial board, with a warning."""
        found = self.memory.state.observations
        try:
            kept, self._lost = journal.begin(trial_id)
            memory = world.restored(self.memory, (*found, *kept) if kept else ())
            if memory is None:
                self._lost = journal.refuse()
            else:
                self.memory = memory
        except RecordError as error:
            self._lost = str(error)
        if self._lost:
            self.get_logger().warning(self._lost)
        return (self.memory.state,)

    def _failure(self, action: PlaceBlock | ArmReport, reason: str) -> tuple[Message, ...]:
        """No block can be placed any more."""
        self.get_logger().error(
            reason,
            throttle_duration_sec=WARN_PERIOD_S,
            throttle_time_source_type=self.steady,
        )
        code = PlacementCode.FAILED
        return (PlacementOutcome(action.trial_id, action.sequence, None, reason, code),)

    def take(self, message: Message) -> None:
        """See :class:`PartNode`; the arm works for the trial that runs only."""
        before = self.memory.state
        super().take(message)
        after = self.memory.state
        is_left = before is not None and (after is None or after.trial_id != before.trial_id)
        if is_left and self._arm is not None:
            self._arm.stop()

    def perform(self, message: Message) -> None:
        """Have an order carried out by the arm."""
        assert isinstance(message, ArmOrder)
        if self._arm is None:
            self._arm = Arm(self, self.stamped, self.take, self.values['cell_size'])
        self._arm.carry_out(message, self.board)

    @property
    def is_busy(self) -> bool:
        """See :class:`PartNode`."""
        return self.memory.state is not None

    def load(self) -> dict[str, object]:
        """See :class:`PartNode`."""
        state = self.memory.state
        return {
            'blocks_placed': 0 if state is None else len(state.placements),
            'observations': 0 if state is None else len(state.observations),
            'placing': self._placing is not None,
            'journal': self._lost or ('none' if self._journal is None else 'kept'),
        }

    def receive(self, message: Message) -> None:
        """Execute an action after ``placing_s``; another action of the trial does not stop it."""
        if not isinstance(message, PlaceBlock) or self.values['placing_s'] == 0:
            super().receive(message)
        elif self._placing is None or self._placing.trial_id != message.trial_id:
            self._placing, self._began_s = message, self.now_s
            self._placed.reset()
            self._news.reset()

    def _tell_progress(self) -> None:
        action = self._placing
        if action is None or self.trial is None or action.trial_id != self.trial.trial_id:
            return
        progress = min(1.0, (self.now_s - self._began_s) / self.values['placing_s'])
        code = PlacementCode.IN_PROGRESS
        self.say(
            PlacementOutcome(action.trial_id, action.sequence, None, code=code, progress=progress)
        )

    def _place(self) -> None:
        self._placed.cancel()
        self._news.cancel()
        action, self._placing = self._placing, None
        if action is not None:
            super().receive(action)


def make_node(**options: Any) -> World:
    """The node, not yet spinning."""
    return World(**options)


def main() -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(lambda _: make_node())


if __name__ == '__main__':
    main()
