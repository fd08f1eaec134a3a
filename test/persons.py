"""People who scope: what they propose follows from what they see, and from a seed."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

from builders import task

from blocks_planning.board.geometry import Mask
from blocks_planning.search.searches import make_search
from blocks_planning.subgoals.human import Human
from blocks_planning.subgoals.proposals import Proposal, ProposalKind, target_of
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message, WorldState
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec

BUILD, WITHDRAWN, GIVE_UP = ProposalKind


def human_spec(rows: str, search: str = 'bfs', **settings: Any) -> TrialSpec:
    """A trial in which a person scopes."""
    strategy = Human('P01', str(settings.pop('costs', 'shown')))
    return TrialSpec('small', task(rows), strategy, make_search(search, settings), 0, 2000)


def rows_of(spec: TrialSpec, *heights: int) -> list[Proposal]:
    """One proposal after the other, none of which is refused: the rows below each height.

    They are numbered as if each led to as many blocks as the next one says.
    """
    person = Person(spec, heights=list(heights))
    run_trial(spec, observe=person.observe, proposals=person)
    return person.said


@dataclass
class Person:
    """Proposes rectangles, lets some of them go, and gives up after a while.

    Hand :meth:`observe` and the person itself to ``run_trial``.
    """

    spec: TrialSpec
    seed: int = 0
    heights: list[int] | None = None
    patience: int = 6
    said: list[Proposal] = field(default_factory=list)
    state: WorldState | None = None

    def observe(self, message: Message) -> None:
        """See what is on the board."""
        if isinstance(message, WorldState):
            self.state = message

    def __iter__(self) -> Iterator[Proposal]:
        chance = random.Random(self.seed)
        while True:
            assert self.state is not None
            here = [one for one in self.said if one.sequence == self.state.sequence]
            kind, region = self._word(chance, len(here))
            self.said.append(
                Proposal(self.state.sequence, len(here), kind, region, chance.randrange(99) / 8)
            )
            yield self.said[-1]

    def repeat(self) -> Proposal:
        """The last word once more."""
        last = self.said[-1]
        self.said.append(replace(last, number=last.number + 1))
        return self.said[-1]

    def _word(self, chance: random.Random, tried: int) -> tuple[ProposalKind, Mask]:
        task, board = self.spec.task, self.spec.task.board
        assert self.state is not None
        if self.heights is not None:
            return (BUILD, task.rows(self.heights.pop(0))) if self.heights else (GIVE_UP, 0)
        if tried >= self.patience:
            return GIVE_UP, 0
        left, right = sorted(chance.choices(range(board.width + 1), k=2))
        top = chance.randint(1, board.height)
        region = board.mask((c, r) for c in range(left, right) for r in range(top))
        nothing = target_of(task, self.state.built, region) == self.state.built
        kind = WITHDRAWN if nothing or chance.random() < 0.2 else BUILD
        return kind, region


def human_record(rows: str, seed: int = 0, **settings: Any) -> TrialRecord:
    """The record of a trial in which a person scoped."""
    spec = human_spec(rows, **settings)
    person = Person(spec, seed)
    return run_trial(spec, observe=person.observe, proposals=person)
