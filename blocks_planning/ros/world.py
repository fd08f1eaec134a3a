"""Node ``world``: the board, the only mutable truth.

Replace it by the driver of real hardware and nothing else has to change. With a ``journal_dir`` a
world that was killed and started again goes on with the board of the running trial.

| | |
|---|---|
| listens | `trial`, `outcome` (latched), `action` (stream) |
| says | `state` (latched), `action/outcome` (stream) |
| parameters | `remind_period_s`; `journal_dir`: folder of the journal; `placing_s`: how long placing a block takes |
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from blocks_planning.board.blocks import Placed
from blocks_planning.ros.graph import WORLD
from blocks_planning.ros.journal import Journal
from blocks_planning.ros.parameters import Parameter
from blocks_planning.ros.part_node import PartNode
from blocks_planning.ros.runtime import run
from blocks_planning.trials import world
from blocks_planning.trials.messages import (
    Message,
    PlaceBlock,
    TrialEnded,
    TrialStarted,
    WorldState,
)

JOURNAL_DIR = Parameter('journal_dir', '', 'Folder of the journal; none: no journal.')
PLACING = Parameter('placing_s', 0.0, 'How long placing a block takes [s].', (0.0, 3600.0))


class World(PartNode):
    """The world, with a journal."""

    def __init__(self, **options: Any) -> None:
        """See :class:`PartNode`."""
        super().__init__(WORLD, world, (JOURNAL_DIR, PLACING), **options)
        folder = self.values['journal_dir']
        self._journal = Journal(Path(folder)) if folder else None
        self._restoring = False
        self._placing: PlaceBlock | None = None
        self._arm = self.create_timer(
            max(self.values['placing_s'], 1e-3), self._place, clock=self.steady
        )
        self._arm.cancel()

    def take(self, message: Message) -> None:
        """See :class:`PartNode`; a trial that was under way goes on where it was."""
        placements: list[Placed] = []
        running = None if self.memory.state is None else self.memory.state.trial_id
        is_new = isinstance(message, TrialStarted) and message.trial_id != running
        if self._journal is not None and is_new:
            placements, warning = self._journal.begin(message.trial_id)
            if warning:
                self.get_logger().warning(warning)
        super().take(message)
        if placements:
            self._restore(message.trial_id, placements)
        if self._journal is not None and isinstance(message, TrialEnded):
            self._journal.end()

    def say(self, message: Message) -> None:
        """See :class:`PartNode`; what is said is in the journal first."""
        if self._restoring:
            return
        if self._journal is not None and isinstance(message, WorldState) and message.placements:
            self._journal.append(message.placements[-1])
        super().say(message)

    def receive(self, message: Message) -> None:
        """Carry out an action in its time; the arm is not stopped by another of its trial."""
        if not isinstance(message, PlaceBlock) or self.values['placing_s'] == 0:
            super().receive(message)
        elif self._placing is None or self._placing.trial_id != message.trial_id:
            self._placing = message
            self._arm.reset()

    def _place(self) -> None:
        self._arm.cancel()
        action, self._placing = self._placing, None
        if action is not None:
            super().receive(action)

    def _restore(self, trial_id: str, placements: list[Placed]) -> None:
        self._restoring = True
        for sequence, placed in enumerate(placements):
            super().take(PlaceBlock(trial_id, sequence, placed.placement))
        self._restoring = False
        super().say(self.memory.state)


def make_node(**options: Any) -> World:
    """The node, not yet spinning."""
    return World(**options)


def main() -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(lambda _: make_node())


if __name__ == '__main__':
    main()
