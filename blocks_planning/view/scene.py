"""The visible state of a trial at one moment, for every view.

A :class:`Scene` is folded from the messages of a trial, live (:func:`scene_after`) or replayed
from its record (:func:`scenes_of`). Both give the same scenes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate
from typing import NamedTuple

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.subgoals.decision import Decision, Subgoal
from blocks_planning.trials.execution import Progress, Span, SubgoalChosen, history, spans_of
from blocks_planning.trials.messages import (
    Message,
    TrialEnded,
    TrialStarted,
    WorldState,
    observed,
)
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.worlds.observation import Observation, Observations

FOUND = -1
"""Marks a block that no subgoal placed: it stood at the start, or appeared by itself."""


class BuiltBlock(NamedTuple):
    """A block of the tower, and the subgoal of the trial, counted from 0, that placed it."""

    placed: Placed
    subgoal: int


@dataclass(frozen=True)
class Scene:
    """A trial at one moment.

    Attributes:
        trial: the trial.
        observations: of the board, so far.
        chosen: the subgoal that was begun last, with all decisions so far.
        status: building, until the trial is over.
        reason: why the trial was cancelled.
    """

    trial: TrialStarted
    observations: Observations = ()
    chosen: SubgoalChosen | None = None
    status: TrialStatus = TrialStatus.BUILDING
    reason: str = ''

    @property
    def spec(self) -> TrialSpec:
        """The specification of the trial."""
        return self.trial.spec

    @property
    def task(self) -> Task:
        """The task."""
        return self.spec.task

    @property
    def sequence(self) -> int:
        """The number of the latest observation; 0 before the first as well."""
        return max(len(self.observations) - 1, 0)

    @property
    def placements(self) -> tuple[Placed, ...]:
        """The blocks that stand, in the order in which they landed."""
        return self.record.placements

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
    def progress(self) -> Progress | None:
        """How far the current subgoal has been executed; None if there is none yet."""
        if self.subgoal is None or self.chosen is None or self.chosen.sequence > self.sequence:
            return None
        seen = history(self.task.board, self.observations or (Observation(),))
        return self.chosen.progress(self.spec, seen)

    @cached_property
    def landed(self) -> tuple[BuiltBlock, ...]:
        """Every block that has landed, also those that are gone, in the order of landing."""
        starts = [span.start for span in self._spans]
        blocks: list[BuiltBlock] = []
        subgoal = FOUND
        for sequence, seen in enumerate(self.observations):
            while subgoal + 1 < len(starts) and starts[subgoal + 1] < sequence:
                subgoal += 1
            owner = FOUND if seen.ordered is None else subgoal
            blocks += [BuiltBlock(placed, owner) for placed in seen.landed]
        return tuple(blocks)

    @cached_property
    def standing(self) -> tuple[int, ...]:
        """Indices in :attr:`landed` of the blocks that stand."""
        standing: list[int] = []
        number = 0
        for seen in self.observations:
            gone = set(seen.gone)
            standing = [index for index in standing if self.landed[index].placed not in gone]
            standing += range(number, number + len(seen.landed))
            number += len(seen.landed)
        return tuple(standing)

    @property
    def blocks(self) -> tuple[BuiltBlock, ...]:
        """The blocks that stand, with the subgoals that they belong to."""
        return tuple(self.landed[index] for index in self.standing)

    @property
    def built(self) -> Mask:
        """The filled cells."""
        return self.record.built

    @property
    def region(self) -> Mask:
        """The cells that the current subgoal still has to fill; empty if there is none."""
        return 0 if self.subgoal is None else self.subgoal.target & ~self.built

    @property
    def label(self) -> str:
        """The label of the region that is being filled, such as 'rows 4'; '' if there is none."""
        return str(self.subgoal.region.label) if self.subgoal and self.region else ''

    @property
    def top(self) -> int:
        """Number of rows up to the top of the current region; 0 if there is none."""
        if self.subgoal is None:
            return 0
        return self.task.board.rows_up_to(self.subgoal.region.cells)

    @cached_property
    def record(self) -> TrialRecord:
        """The record if the trial were over now, with all counts and costs."""
        return TrialRecord(
            spec=self.spec,
            status=self.status,
            observations=self.observations,
            decisions=() if self.chosen is None else self.chosen.decisions,
            proposals=() if self.chosen is None else self.chosen.proposals,
            reason=self.reason,
        )

    @cached_property
    def _spans(self) -> list[Span]:
        return list(spans_of(self.record))


def scene_of(spec: TrialSpec) -> Scene:
    """The scene before the start of a trial."""
    return first_scene(TrialStarted(spec.trial_id, spec))


def first_scene(trial: TrialStarted) -> Scene:
    """The scene of a trial that has just started, with the board of its specification."""
    return Scene(trial, (Observation(landed=trial.spec.built),))


def scene_after(scene: Scene, message: Message) -> Scene:
    """The scene after a message; the same object if nothing changed.

    The start of another trial clears the scene. Messages that are stale, repeated or of another
    trial are ignored. States and subgoals may arrive in either order.
    """
    if message.trial_id != scene.trial.trial_id:
        return first_scene(message) if isinstance(message, TrialStarted) else scene
    match message:
        case WorldState() if _is_news(message, scene):
            return replace(scene, observations=message.observations)
        case SubgoalChosen() if scene.chosen is None or message.sequence > scene.chosen.sequence:
            return replace(scene, chosen=message)
        case TrialEnded() if message.status is not scene.status:
            return replace(scene, status=message.status, reason=message.reason)
    return scene


def _is_news(state: WorldState, scene: Scene) -> bool:
    """Whether a state has more observations, or its first one differs from the specification."""
    known, said = len(scene.observations), len(state.observations)
    return said > known or (said == known == 1 and state.observations != scene.observations)


def scenes_of(record: TrialRecord) -> Iterator[Scene]:
    """Replay a trial.

    Yields:
        A scene for the start, for every subgoal begun (or given up), for every observation after
        the first, and for the end.
    """
    start = replace(scene_of(record.spec), observations=record.observations[:1])
    return accumulate(_messages_of(record), scene_after, initial=start)


def last_scene(record: TrialRecord) -> Scene:
    """The scene at the end of a trial."""
    *_, last = scenes_of(record)
    return last


def _messages_of(record: TrialRecord) -> Iterator[Message]:
    """The messages of a trial that change its scene."""
    trial_id, board = record.spec.trial_id, record.spec.task.board
    chosen = {message.sequence: message for message in _choices(record)}
    for count in range(1, len(record.observations) + 1):
        if count > 1:
            yield observed(trial_id, board, record.observations[:count], TrialStatus.BUILDING)
        if count - 1 in chosen:
            yield chosen[count - 1]
    yield TrialEnded(trial_id, record.status, record.reason)


def _choices(record: TrialRecord) -> Iterator[SubgoalChosen]:
    """Every subgoal when it was begun, and giving up."""
    starts = {(span.decision, span.subgoal): span.start for span in spans_of(record)}
    for index, entry in enumerate(record.decisions):
        for executed in range(min(entry.executed, 1), entry.executed + 1):
            start = starts.get((index, max(executed - 1, 0)), entry.sequence)
            decisions = (*record.decisions[:index], replace(entry, executed=executed))
            proposals = tuple(p for p in record.proposals if p.sequence <= entry.sequence)
            yield SubgoalChosen(record.spec.trial_id, start, decisions, proposals)
