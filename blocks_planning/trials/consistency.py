"""Checks whether a message is consistent with the earlier messages of its trial.

A message can be well formed and yet impossible: a board that does not follow from the last one, a
status that contradicts the board, a block that is not in the library. No correct part sends such a
message, so it is refused. A consistent message is accepted: the sender of the next state of a trial
is taken for its world.
"""

from __future__ import annotations

from collections.abc import Iterable

from blocks_planning.board.blocks import Placed, format_library
from blocks_planning.board.geometry import Mask
from blocks_planning.errors import InvalidInput
from blocks_planning.subgoals.decision import Query
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.messages import (
    Message,
    SearchAnswer,
    SearchRequest,
    WorldState,
)
from blocks_planning.trials.record import DecisionRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.world import status_of
from blocks_planning.worlds.observation import (
    Observations,
    impossible,
    mask_of,
    states_of,
)


class Contradiction(InvalidInput):
    """A message that contradicts its trial or the earlier messages of the trial."""


class Consistency:
    """The facts about a trial with which later messages must be consistent.

    Attributes:
        spec: specification of the trial.
    """

    def __init__(self, spec: TrialSpec) -> None:
        """Nothing is known yet."""
        self.spec = spec
        self._observations: Observations = ()
        self._states: list[Mask] = []
        self._decisions: tuple[DecisionRecord, ...] = ()

    def check(self, message: Message) -> None:
        """Check a message of this trial, and remember it if it is consistent.

        Raises:
            Contradiction: if it is inconsistent; then it is not remembered.
        """
        match message:
            case WorldState():
                self._check_state(message)
            case SubgoalChosen():
                self._check_subgoal(message)
            case SearchRequest(_, queries):
                for query in queries:
                    self._check_query(query)
            case SearchAnswer(_, _, result):
                self._check_blocks(result.placements, 'placements')
                if result.solution_cost > result.planning_cost:
                    raise Contradiction(
                        'solution_cost: is above the planning cost of all attempts'
                    )

    def _check_query(self, query: Query) -> None:
        if query.target & ~query.built & ~self.spec.task.silhouette:
            raise Contradiction('queries: a target has cells outside the silhouette')
        filled = query.built if self.spec.plans_on_blocks else 0
        if mask_of(self.spec.task.board, query.blocks) != filled:
            raise Contradiction(
                'queries: expected the blocks that fill what is built if the search plans on '
                f'blocks, and no blocks otherwise, got {len(query.blocks)} blocks'
            )

    def _check_state(self, state: WorldState) -> None:
        if not _is_one_way(self._observations, state.observations):
            raise Contradiction('observations: do not continue those of the previous state')
        if self.spec.world.simulates:
            self._check_blocks(state.placements, 'placements')
        problem = impossible(self.spec.task.board, state.placements)
        if problem:
            raise Contradiction(f'placements: {problem}')
        self._check_status(state)
        if len(state.observations) > len(self._observations):
            is_next = len(state.observations) == len(self._observations) + 1
            self._states = (
                [*self._states, state.built]
                if is_next
                else states_of(self.spec.task.board, state.observations)
            )
            self._observations = state.observations

    def _check_status(self, state: WorldState) -> None:
        """A world may report a stuck board as building; then the planner gives up."""
        is_complete = state.built == self.spec.task.silhouette
        if (state.status is TrialStatus.SUCCESS) != is_complete:
            raise Contradiction(f'status: {state.status.value} contradicts the placements')
        if state.status is TrialStatus.STUCK:
            reached = status_of(self.spec, state.placements, state.built)
            if reached is not TrialStatus.STUCK:
                raise Contradiction('status: stuck, but a legal placement is left')

    def _check_subgoal(self, chosen: SubgoalChosen) -> None:
        decisions = chosen.decisions
        self._check_decisions(decisions)
        if chosen.proposals and not self.spec.strategy.asks_person:
            raise Contradiction('proposals: the strategy asks no person')
        begun = [(entry.sequence, entry.decision.built) for entry in decisions]
        if (
            not self.spec.strategy.is_blind
        ):  # else a later subgoal begins wherever the plan has led
            begun.append((chosen.sequence, chosen.built))
        for sequence, built in begun:
            if sequence < len(self._states) and self._states[sequence] != built:
                raise Contradiction(f'built: differs from the state of observation {sequence}')
        if chosen.sequence < decisions[-1].sequence:
            raise Contradiction(
                f'sequence: must be {decisions[-1].sequence} or more after these decisions'
            )
        if chosen.index == 0 and chosen.sequence != decisions[-1].sequence:
            raise Contradiction(f'sequence: must be {decisions[-1].sequence} for a new decision')
        if len(decisions) >= len(self._decisions):
            self._decisions = decisions

    def _check_decisions(self, decisions: tuple[DecisionRecord, ...]) -> None:
        places = [entry.sequence for entry in decisions]
        if places[0] != 0 or places != sorted(set(places)):
            raise Contradiction('decisions: are not in the order of their states, from the first')
        if any(not entry.decision.subgoals for entry in decisions[:-1]):
            raise Contradiction('decisions: continue after the planner gave up')
        for index, entry in enumerate(decisions):
            for subgoal in entry.decision.subgoals:
                self._check_blocks(subgoal.placements, f'decisions[{index}]')
        if not _is_one_way(*map(_decided, (self._decisions, decisions))):
            raise Contradiction('decisions: do not continue the earlier ones')

    def _check_blocks(self, placements: Iterable[Placed], field: str) -> None:
        library = self.spec.task.library
        for placed in placements:
            block = placed.placement.block
            if block not in library and placed not in self.spec.built:
                known = format_library(library)
                raise Contradiction(f'{field}: block {block} is not in the library {known}')


def _decided(decisions: Iterable[DecisionRecord]) -> tuple[object, ...]:
    """The parts of decisions that are final; the number of executed subgoals still grows."""
    return tuple((entry.sequence, entry.decision) for entry in decisions)


def _is_one_way(one: tuple[object, ...], other: tuple[object, ...]) -> bool:
    """Whether the longer of two sequences begins with the shorter one."""
    length = min(len(one), len(other))
    return one[:length] == other[:length]
