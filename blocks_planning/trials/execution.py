"""How far a decision has been executed, according to the observations.

A decision names one or more subgoals. They are executed one after the other; the one that is being
executed is *current*. The states that its plan passes through are its *way*. Each observation
is compared with the way::

    sequence      4        5        6        7        8
    state         s4       s5       s5       s6       x
    ordered            a        b        b        c
    position      0        1        1        2        surprise
                  |<------- way of the subgoal ------->
    way           w0=s4    w1=s5    w2=s6    w3

* the state is the next one on the way: one more placement of the plan is done;
* the state is unchanged: the order was lost, and is repeated;
* the state is any other: a *surprise*. The plan no longer holds, and a new decision is due.

A strategy may ignore surprises (``is_blind``). Then an order counts as done when a block has
landed, no matter where, and the execution ends early only if the next order is impossible.

The subgoal ends when ``execute`` placements are done. Then the next subgoal of the decision
becomes current, or, after the last one, a new decision is due.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from blocks_planning.board import rules
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.subgoals.decision import Decision, Subgoal
from blocks_planning.subgoals.proposals import Proposal
from blocks_planning.trials.record import DecisionRecord, TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.worlds.observation import Blocks, Observations, standing, states_of


class Progress(NamedTuple):
    """How far a subgoal has been executed.

    Attributes:
        done: number of placements of its plan that were carried out.
        sequence: of the last state that was considered: the one in which it ended, or in which
            the surprise was observed, or the latest.
        is_done: whether everything to execute has been carried out.
        is_surprised: whether the state is not on the way.
    """

    done: int
    sequence: int
    is_done: bool
    is_surprised: bool

    @property
    def is_open(self) -> bool:
        """Whether the next placement can be ordered."""
        return not self.is_done and not self.is_surprised


class History(NamedTuple):
    """The observations of a trial, and the filled cells after each; the index is the sequence."""

    observations: Observations
    states: list[Mask]


def history(board: Board, observations: Observations) -> History:
    """The history of some observations."""
    return History(observations, states_of(board, observations))


def progress_of(
    spec: TrialSpec, built: Mask, subgoal: Subgoal | None, start: int, seen: History
) -> Progress:
    """How far a subgoal has been executed.

    Args:
        spec: of the trial.
        built: the state from which it was planned.
        subgoal: what is executed; None if the planner gave up.
        start: sequence of the state in which execution began.
        seen: the observations so far.
    """
    if subgoal is not None and spec.strategy.is_blind:
        return _follow_blindly(spec.task.board, subgoal, start, seen)
    return _follow(way_of(spec.task.board, built, subgoal), start, seen.states)


def _follow(way: Sequence[Mask], start: int, states: Sequence[Mask]) -> Progress:
    """Follow the observed states along a way, up to its end or a surprise."""
    if states[start] != way[0]:
        return Progress(0, start, is_done=False, is_surprised=True)
    done, last = 0, len(way) - 1
    for sequence in range(start, len(states)):
        built = states[sequence]
        if done < last and built == way[done + 1]:
            done += 1
        elif built != way[done]:
            return Progress(done, sequence, is_done=False, is_surprised=True)
        if done == last:
            return Progress(done, sequence, is_done=True, is_surprised=False)
    return Progress(done, len(states) - 1, is_done=False, is_surprised=False)


def _follow_blindly(board: Board, subgoal: Subgoal, start: int, seen: History) -> Progress:
    """Count the orders that placed a block, wherever it landed."""
    done = 0
    for sequence in range(start, len(seen.states)):
        if sequence > start:
            observation = seen.observations[sequence]
            done += observation.ordered is not None and bool(observation.landed)
        if done == subgoal.execute:
            return Progress(done, sequence, is_done=True, is_surprised=False)
    following = subgoal.placements[done].placement
    is_possible = rules.drop(board, seen.states[-1], following) is not None
    return Progress(done, len(seen.states) - 1, is_done=False, is_surprised=not is_possible)


@dataclass(frozen=True)
class SubgoalChosen:
    """The subgoal to execute from the state ``sequence`` on, or that the planner gives up.

    It contains all decisions of the trial, so that a part that missed one, or starts late, has the
    same information as the others. The current subgoal is the last one begun of the last decision.

    Attributes:
        trial_id: of the trial.
        sequence: of the state from which the current subgoal is executed.
        decisions: of the trial so far.
        proposals: of a person, those that led to the decisions.
    """

    trial_id: str
    sequence: int
    decisions: tuple[DecisionRecord, ...]
    proposals: tuple[Proposal, ...] = ()

    @property
    def decision(self) -> Decision:
        """The last decision."""
        return self.decisions[-1].decision

    @property
    def index(self) -> int:
        """Index of the current subgoal in the last decision."""
        return max(0, self.decisions[-1].executed - 1)

    @property
    def subgoal(self) -> Subgoal | None:
        """The current subgoal; None if the planner gives up."""
        return self.decision.subgoals[self.index] if self.decision.subgoals else None

    @property
    def built(self) -> Mask:
        """The state from which the current subgoal was planned."""
        return self.decision.subgoals[self.index - 1].target if self.index else self.decision.built

    def blocks(self, observations: Observations) -> Blocks:
        """The blocks of the state from which the current subgoal was planned."""
        blocks = standing(observations[: self.decisions[-1].sequence + 1])
        for earlier in self.decision.subgoals[: self.index]:
            blocks += earlier.placements
        return blocks

    def progress(self, spec: TrialSpec, seen: History) -> Progress:
        """How far the current subgoal has been executed."""
        return progress_of(spec, self.built, self.subgoal, self.sequence, seen)

    def begun(self, sequence: int, executed: int) -> SubgoalChosen:
        """The same decisions when the ``executed``-th subgoal of the last one has been begun."""
        last = replace(self.decisions[-1], executed=executed)
        return replace(self, sequence=sequence, decisions=(*self.decisions[:-1], last))

    @property
    def has_next(self) -> bool:
        """Whether the last decision has another subgoal after the current one."""
        return self.index + 1 < len(self.decision.subgoals)


def way_of(board: Board, built: Mask, subgoal: Subgoal | None) -> list[Mask]:
    """The states that the execution of a subgoal passes through, beginning with ``built``."""
    placements = subgoal.placements[: subgoal.execute] if subgoal else ()
    return rules.states_along(board, built, placements)


class Span(NamedTuple):
    """The execution of one subgoal of a trial.

    Attributes:
        decision: index of its decision.
        subgoal: its index in that decision.
        start: sequence of the state in which it was begun.
        progress: how far it was executed.
    """

    decision: int
    subgoal: int
    start: int
    progress: Progress


def spans_of(record: TrialRecord) -> Iterator[Span]:
    """Every subgoal that was begun in a trial, in order, and how far it was executed."""
    spec = record.spec
    seen = history(spec.task.board, record.observations)
    for number, entry in enumerate(record.decisions):
        start, built = entry.sequence, entry.decision.built
        for index, subgoal in enumerate(entry.decision.subgoals[: entry.executed]):
            if start >= len(seen.states):
                break
            progress = progress_of(spec, built, subgoal, start, seen)
            yield Span(number, index, start, progress)
            start, built = progress.sequence, subgoal.target
