"""Options that need no solving, for tests of fits: random ones, the same for the same state."""

from __future__ import annotations

import random

import builders

from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.fitting.options import Option, Sequence
from blocks_planning.fitting.points import Asking, ChoicePoint
from blocks_planning.search.searches import RandomPlacement

TASK = builders.task('/'.join(['########'] * 8))
ASKING = Asking(RandomPlacement(), 0, 0)


class MadeUp:
    """Six to nine options in each state, each with some sequences."""

    def __init__(self, salt: int = 0, ahead: int = 1) -> None:
        self._salt = salt
        self._ahead = ahead

    def options(self, task: Task, built: Mask, asking: Asking) -> tuple[Option, ...]:
        source = random.Random(f'{self._salt} {built}')
        left = task.silhouette & ~built
        cut = [task.board.rectangle(c, r, 2, 2) & left for c in range(7) for r in range(7)]
        cells = source.sample(sorted(set(cut) - {0}), source.randint(6, 9))
        return tuple(Option(one, self._sequences(source)) for one in cells)

    def _sequences(self, source: random.Random) -> tuple[Sequence, ...]:
        if source.random() < 0.1:
            return ()
        number = source.randint(1, self._ahead)
        return tuple(
            Sequence(source.randint(2, 24), round(10 ** source.uniform(1, 4)))
            for _ in range(number)
        )


def points(session: str, towers: int = 16, each: int = 4) -> list[ChoicePoint]:
    """States in which nothing has been chosen yet; those of two sessions differ."""
    source = random.Random(session)
    return [
        ChoicePoint(session, str(tower), TASK, source.getrandbits(32), 0, ASKING)
        for tower in range(towers)
        for _ in range(each)
    ]
