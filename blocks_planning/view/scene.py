"""What there is to see of a trial at one moment, whoever draws it.

A :class:`Scene` is folded from the messages of a trial, live (:func:`scene_after`) or replayed
from its record (:func:`scenes_of`). Both give the same scenes.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate
from typing import NamedTuple

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.subgoals.decision import Decision, Subgoal
from blocks_planning.trials.messages import (
    Message,
    SubgoalChosen,
    TrialEnded,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.record import DecisionRecord, TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus


class BuiltBlock(NamedTuple):
    """A block of the tower, and for which subgoal of the trial, counted from 0, it was placed."""

    placed: Placed
    subgoal: int


@dataclass(frozen=True)
class Scene:
    """A trial at one moment.

    Attributes:
        trial: which one.
        placements: what stands, in the order in which it was placed.
        chosen: the subgoal that was begun last, with all decisions so far.
        status: building, until the trial is over.
    """

    trial: TrialStarted
    placements: tuple[Placed, ...] = ()
    chosen: SubgoalChosen | None = None
    status: TrialStatus = TrialStatus.BUILDING

    @property
    def spec(self) -> TrialSpec:
        """What the trial was started with."""
        return self.trial.spec

    @property
    def task(self) -> Task:
        """What is to be built."""
        return self.spec.task

    @property
    def decision(self) -> Decision | None:
        """The last decision; None before the first."""
        return None if self.chosen is None else self.chosen.decision

    @property
    def subgoal(self) -> Subgoal | None:
        """The subgoal that is being executed; None before the first and at the end."""
        if self.chosen is None or self.status is not TrialStatus.BUILDING:
            return None
        return self.chosen.subgoal

    @cached_property
    def blocks(self) -> tuple[BuiltBlock, ...]:
        """What stands, with the subgoals that it belongs to."""
        starts = list(_starts(self.record.decisions))
        return tuple(
            BuiltBlock(placed, bisect_right(starts, index) - 1)
            for index, placed in enumerate(self.placements)
        )

    @cached_property
    def built(self) -> Mask:
        """The filled cells."""
        return rules.states_along(self.task.board, 0, self.placements)[-1]

    @property
    def region(self) -> Mask:
        """The cells that the current subgoal still has to fill; empty if there is none."""
        return 0 if self.subgoal is None else self.subgoal.region & ~self.built

    @property
    def record(self) -> TrialRecord:
        """What the record would be if the trial were over now; it has all counts and costs."""
        decisions = () if self.chosen is None else self.chosen.decisions
        proposals = () if self.chosen is None else self.chosen.proposals
        return TrialRecord(self.spec, self.status, self.placements, decisions, proposals)


def scene_of(spec: TrialSpec) -> Scene:
    """The scene before anything has happened."""
    return Scene(TrialStarted(spec.trial_id, spec))


def scene_after(scene: Scene, message: Message) -> Scene:
    """The scene after a message; the same object if there is nothing new to see.

    Another trial that starts clears the scene. What is stale, doubled or of another trial is
    ignored. States and subgoals may come in either order.
    """
    if message.trial_id != scene.trial.trial_id:
        return Scene(message) if isinstance(message, TrialStarted) else scene
    match message:
        case WorldState() if message.sequence > len(scene.placements):
            return replace(scene, placements=message.placements)
        case SubgoalChosen() if scene.chosen is None or message.sequence > scene.chosen.sequence:
            return replace(scene, chosen=message)
        case TrialEnded() if message.status is not scene.status:
            return replace(scene, status=message.status)
    return scene


def scenes_of(record: TrialRecord) -> Iterator[Scene]:
    """Replay a trial.

    Yields:
        A scene for the start, for every subgoal begun (or given up), for every placement, and for
        the end.
    """
    return accumulate(_messages_of(record), scene_after, initial=scene_of(record.spec))


def last_scene(record: TrialRecord) -> Scene:
    """The scene at the end of a trial."""
    *_, last = scenes_of(record)
    return last


def _messages_of(record: TrialRecord) -> Iterator[Message]:
    """What was said in a trial, as far as it can be seen in a scene."""
    trial_id = record.spec.trial_id
    chosen = {message.sequence: message for message in _choices(record)}
    states = rules.states_along(record.spec.task.board, 0, record.placements)
    for count, built in enumerate(states):
        if count:
            placements = record.placements[:count]
            yield WorldState(trial_id, count, built, placements, TrialStatus.BUILDING)
        if count in chosen:
            yield chosen[count]
    yield TrialEnded(trial_id, record.status)


def _choices(record: TrialRecord) -> Iterator[SubgoalChosen]:
    """Every subgoal when it was begun, and giving up."""
    for index, entry in enumerate(record.decisions):
        starts = list(_starts((entry,))) or [entry.placed]
        for executed, start in enumerate(starts, start=min(entry.executed, 1)):
            decisions = (*record.decisions[:index], replace(entry, executed=executed))
            proposals = tuple(p for p in record.proposals if p.sequence <= entry.placed)
            yield SubgoalChosen(record.spec.trial_id, start, decisions, proposals)


def _starts(decisions: tuple[DecisionRecord, ...]) -> Iterator[int]:
    """After how many placements each subgoal was begun."""
    for entry in decisions:
        start = entry.placed
        for subgoal in entry.decision.subgoals[: entry.executed]:
            yield start
            start += subgoal.execute
