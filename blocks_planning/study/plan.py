"""What a participant goes through, step by step: a pure function of the study and a number.

The rows of both orders count on together: with C conditions and T towers, C times T participants
meet every order of conditions with every order of towers, if the order is a Latin square. A
participant gets the towers in the same order in each condition.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import Enum
from typing import Any, NamedTuple

from blocks_planning.errors import ConfigurationError
from blocks_planning.search.randomness import MAX_SEED
from blocks_planning.settings import Setting
from blocks_planning.study.modes import Mode
from blocks_planning.study.orders import ORDERS, ordered
from blocks_planning.study.spec import Condition, Study
from blocks_planning.subgoals.human import Human
from blocks_planning.trials.script import Tower
from blocks_planning.trials.spec import TrialSpec

CODE = Setting(
    str,
    'Code of a participant.',
    'participant',
    pattern=r'[A-Za-z0-9_-]{1,32}',
    expected='a code of 1 to 32 letters, digits, _ and -',
)
"""What may be a participant's code; it names a folder."""


class StepKind(str, Enum):
    """What a participant does in a step."""

    CONSENT = 'consent'
    TEXT = 'text'
    MARKING = 'marking'
    TRIAL = 'trial'
    BREAK = 'break'
    DEBRIEF = 'debrief'


class Trial(NamedTuple):
    """A trial of a participant.

    Attributes:
        spec: the trial.
        condition: of the study.
        is_practice: whether it is one of the condition's practice towers.
        number: of the trial among those of the participant that are practice, or are not, from 1.
        total: how many of these there are.
    """

    spec: TrialSpec
    condition: Condition
    is_practice: bool
    number: int
    total: int

    def to_json(self) -> dict[str, Any]:
        """Which trial it is, for tables."""
        return {
            'phase': 'practice' if self.is_practice else 'trial',
            'number': self.number,
            'condition': self.condition.name,
            'mode': self.condition.mode.name,
            'tower': self.spec.stimulus,
            'seed': self.spec.seed,
            'time_limit_s': self.condition.time_limit_s,
            'trial_id': self.spec.trial_id,
        }


class Step(NamedTuple):
    """A step; it has a text, is a trial, or marks the parts of a trial's silhouette before it."""

    kind: StepKind
    text: str = ''
    trial: Trial | None = None
    marks: Trial | None = None


class _Planned(NamedTuple):
    condition: Condition
    tower: Tower
    is_practice: bool


def steps_of(study: Study, code: str, number: int) -> tuple[Step, ...]:
    """The steps of a participant.

    Args:
        study: the study.
        code: of the participant.
        number: of the participant in the study, from 0.

    Raises:
        ConfigurationError: if the code cannot be one.
    """
    CODE.check(code)
    if number < 0:
        raise ConfigurationError(f'number must be 0 or more, got {number}')
    steps = [Step(StepKind.CONSENT, study.consent)]
    steps += [Step(StepKind.TEXT, text) for text in study.instructions]
    conditions, towers = _orders(study, number)
    planned = [one for condition in conditions for one in _trials(condition, towers)]
    trials = _with_specs(study, code, planned)
    done = 0
    for condition in conditions:
        steps += [Step(StepKind.TEXT, text) for text in condition.instructions]
        for trial in (trial for trial in trials if trial.condition is condition):
            if study.break_every and not trial.is_practice:
                if done and done % study.break_every == 0:
                    steps.append(Step(StepKind.BREAK, study.break_text))
                done += 1
            if condition.mark_parts:
                steps.append(Step(StepKind.MARKING, marks=trial))
            steps.append(Step(StepKind.TRIAL, trial=trial))
    return (*steps, Step(StepKind.DEBRIEF, study.debrief))


def _orders(study: Study, number: int) -> tuple[list[Condition], list[Tower]]:
    order, count = ORDERS[study.order], len(study.conditions)
    seed = f'{study.seed}'
    conditions = ordered(study.conditions, order, number, f'{seed}/conditions')
    if study.conditions_per_person == 'one':
        conditions = [study.conditions[number % count]]
    row, turn = divmod(number, count)
    return conditions, ordered(study.towers, order, row, f'{seed}/towers/{turn}')


def _trials(condition: Condition, towers: list[Tower]) -> Iterator[_Planned]:
    for tower in condition.practice:
        yield _Planned(condition, tower, True)
    for tower in towers:
        yield _Planned(condition, tower, False)


def _with_specs(study: Study, code: str, planned: list[_Planned]) -> list[Trial]:
    """The trials; the seed of one that would be the same as an earlier one is the next number."""
    totals = [sum(one.is_practice is kind for one in planned) for kind in (False, True)]
    counts = [0, 0]
    met: dict[tuple[str, Tower], int] = {}
    trials = []
    for condition, tower, is_practice in planned:
        counts[is_practice] += 1
        before = met.get((condition.mode.name, tower), 0)
        met[condition.mode.name, tower] = before + 1
        seed = (study.seed + before) % (MAX_SEED + 1)
        spec = _spec(study, code, condition.mode, tower, seed)
        number, total = counts[is_practice], totals[is_practice]
        trials.append(Trial(spec, condition, is_practice, number, total))
    return trials


def _spec(study: Study, code: str, mode: Mode, tower: Tower, seed: int) -> TrialSpec:
    search, budget = mode.effort(study.effort)
    return TrialSpec(tower.name, tower.task, Human(code, 'hidden'), search, seed, budget)
