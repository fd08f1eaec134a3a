"""Whether what is said in a trial fits what was said before.

A message can be well formed and yet say what can't be: a board that is not the last one with more
blocks on it, a status that the board does not have, a block that is not in the library. Nobody
who keeps to the rules says that, so it is refused. What fits is believed: who says the next state
of a trial is its world.
"""

from __future__ import annotations

from collections.abc import Iterable

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed, format_library
from blocks_planning.board.geometry import Mask
from blocks_planning.errors import InvalidInput
from blocks_planning.subgoals.human import Human
from blocks_planning.trials.messages import (
    Message,
    SearchAnswer,
    SearchRequest,
    SubgoalChosen,
    WorldState,
)
from blocks_planning.trials.record import DecisionRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.world import status_of


class Contradiction(InvalidInput):
    """A message that does not fit its trial, or what was said in it before."""


class Consistency:
    """What was said of a trial so far, as far as later messages must fit it.

    Attributes:
        spec: what the trial is.
    """

    def __init__(self, spec: TrialSpec) -> None:
        """Nothing was said yet."""
        self.spec = spec
        self._placements: tuple[Placed, ...] = ()
        self._states: list[Mask] = [0]
        self._decisions: tuple[DecisionRecord, ...] = ()

    def check(self, message: Message) -> None:
        """Take note of a message of this trial that fits.

        Raises:
            Contradiction: if it does not; nothing is noted then.
        """
        match message:
            case WorldState():
                self._check_state(message)
            case SubgoalChosen():
                self._check_subgoal(message)
            case SearchRequest(_, query):
                if query.region & ~query.built & ~self.spec.task.silhouette:
                    raise Contradiction('region: asks for cells that are not to be filled')
            case SearchAnswer(_, _, result):
                self._check_blocks(result.placements, 'placements')
                if result.solution_cost > result.planning_cost:
                    raise Contradiction('solution_cost: is more than that of all attempts')

    def _check_state(self, state: WorldState) -> None:
        self._check_blocks(state.placements, 'placements')
        if not _is_one_way(self._placements, state.placements):
            raise Contradiction('placements: do not go on from the state before')
        self._check_status(state)
        if len(state.placements) > len(self._placements):
            self._placements = state.placements
            self._states = rules.states_along(self.spec.task.board, 0, state.placements)

    def _check_status(self, state: WorldState) -> None:
        """A world need not see that it is stuck; then the planner gives up."""
        is_complete = state.built == self.spec.task.silhouette
        if (state.status is TrialStatus.SUCCESS) != is_complete:
            raise Contradiction(f'status: {state.status.value} is not what the placements lead to')
        if state.status is TrialStatus.STUCK:
            reached = status_of(self.spec.task, state.built)
            if reached is not TrialStatus.STUCK:
                raise Contradiction('status: something can still be placed')

    def _check_subgoal(self, chosen: SubgoalChosen) -> None:
        decisions = chosen.decisions
        self._check_decisions(decisions)
        if chosen.proposals and not isinstance(self.spec.strategy, Human):
            raise Contradiction('proposals: no person takes part')
        begun = [(entry.placed, entry.decision.built) for entry in decisions]
        for sequence, built in [*begun, (chosen.sequence, chosen.built)]:
            if sequence < len(self._states) and self._states[sequence] != built:
                raise Contradiction(f'built: is not the state after {sequence} placements')
        least = decisions[-1].placed
        most = least if chosen.index == 0 else self.spec.task.board.size
        if not least <= chosen.sequence <= most:
            raise Contradiction(f'sequence: must be {least} to {most} after these decisions')
        if len(decisions) >= len(self._decisions):
            self._decisions = decisions

    def _check_decisions(self, decisions: tuple[DecisionRecord, ...]) -> None:
        places = [entry.placed for entry in decisions]
        if places[0] != 0 or places != sorted(set(places)):
            raise Contradiction('decisions: are not in the order of their states, from the first')
        if any(not entry.decision.subgoals for entry in decisions[:-1]):
            raise Contradiction('decisions: go on after giving up')
        for index, entry in enumerate(decisions):
            for subgoal in entry.decision.subgoals:
                self._check_blocks(subgoal.placements, f'decisions[{index}]')
        if not _is_one_way(*map(_decided, (self._decisions, decisions))):
            raise Contradiction('decisions: do not go on from those before')

    def _check_blocks(self, placements: Iterable[Placed], field: str) -> None:
        library = self.spec.task.library
        for placed in placements:
            if placed.placement.block not in library:
                block, known = placed.placement.block, format_library(library)
                raise Contradiction(f'{field}: block {block} is not in the library {known}')


def _decided(decisions: Iterable[DecisionRecord]) -> tuple[object, ...]:
    """What does not change any more, unlike how far it was followed."""
    return tuple((entry.placed, entry.decision) for entry in decisions)


def _is_one_way(one: tuple[object, ...], other: tuple[object, ...]) -> bool:
    """Whether the longer of two goes on from the shorter."""
    length = min(len(one), len(other))
    return one[:length] == other[:length]
