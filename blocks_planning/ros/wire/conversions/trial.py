"""Trials: what is announced, and how it ended."""

from __future__ import annotations

from blocks_planning_msgs import msg as ros

from blocks_planning.board.task import Task
from blocks_planning.errors import InvalidInput
from blocks_planning.ros.wire.conversions.cells import (
    block_from_ros,
    grid_from_ros,
    grid_to_ros,
    placed_to_ros,
)
from blocks_planning.ros.wire.conversions.fields import MessageError, refuse, word
from blocks_planning.search.searches import SEARCHES, make_search
from blocks_planning.settings import setting_names, settings_of
from blocks_planning.subgoals.registry import STRATEGIES, make_strategy
from blocks_planning.trials.messages import TrialEnded, TrialStarted
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

_PLANNER_FIELDS = {'lambda': 'lambda_weight'}  # settings whose field has another name
MAX_TRIAL_ID = 200
MAX_STIMULUS = 4096
"""No path is longer [characters]."""
_ALL_SETTINGS = (
    'lambda',
    'commit',
    'participant',
    'costs',
    'depth',
    'iterations',
    'divisor',
    'execute',
)


def spec_to_ros(trial_id: str, spec: TrialSpec) -> ros.TrialSpec:
    """A trial, as it is announced or asked for."""
    planner = ros.PlannerConfig(
        strategy=spec.strategy.name, search=spec.search.name, budget=spec.budget
    )
    for setting, value in (settings_of(spec.strategy) | settings_of(spec.search)).items():
        setattr(planner, _PLANNER_FIELDS.get(setting, setting), value)
    return ros.TrialSpec(
        trial_id=trial_id,
        stimulus=spec.stimulus,
        silhouette=grid_to_ros(spec.task.board, spec.task.silhouette),
        library=[ros.Block(width=b.width, height=b.height) for b in spec.task.library],
        planner=planner,
        seed=spec.seed,
    )


def spec_from_ros(message: ros.TrialSpec) -> TrialSpec:
    """The trial of an announcement or a goal."""
    board, silhouette = grid_from_ros(message.silhouette, 'silhouette')
    library = tuple(
        block_from_ros(block, f'library[{index}]') for index, block in enumerate(message.library)
    )
    if len(message.stimulus) > MAX_STIMULUS:
        raise refuse('stimulus', message.stimulus, f'a name of up to {MAX_STIMULUS} characters')
    config = message.planner
    strategy = word(str, config.strategy, 'planner.strategy', STRATEGIES)
    search = word(str, config.search, 'planner.search', SEARCHES)
    known = [*setting_names(STRATEGIES[strategy]), *setting_names(SEARCHES[search])]
    values = {name: getattr(config, _PLANNER_FIELDS.get(name, name)) for name in _ALL_SETTINGS}
    for name, value in values.items():
        if name not in known and value:
            raise refuse(f'planner.{name}', value, f'nothing with {strategy} and {search}')
    try:
        return TrialSpec(
            stimulus=message.stimulus,
            task=Task(board, silhouette, library),
            strategy=make_strategy(
                strategy, {n: values[n] for n in setting_names(STRATEGIES[strategy])}
            ),
            search=make_search(search, {n: values[n] for n in setting_names(SEARCHES[search])}),
            seed=message.seed,
            budget=config.budget,
        )
    except InvalidInput as error:
        raise MessageError(f'trial: {error}') from None


def started_to_ros(message: TrialStarted) -> ros.TrialSpec:
    """See :class:`TrialStarted`."""
    return spec_to_ros(message.trial_id, message.spec)


def started_from_ros(message: ros.TrialSpec) -> TrialStarted:
    """See :class:`TrialStarted`."""
    if not 1 <= len(message.trial_id) <= MAX_TRIAL_ID or not message.trial_id.isprintable():
        raise refuse('trial_id', message.trial_id, f'a name of up to {MAX_TRIAL_ID} characters')
    return TrialStarted(message.trial_id, spec_from_ros(message))


_OUTCOME_REASONS = {
    TrialStatus.SUCCESS: 'the filled cells are the silhouette',
    TrialStatus.STUCK: 'no legal placement is left',
    TrialStatus.GAVE_UP: 'no subgoal could be solved',
    TrialStatus.CANCELLED: 'the trial was cancelled',
}


def outcome_to_ros(trial_id: str, record: TrialRecord, reason: str = '') -> ros.TrialOutcome:
    """How a trial ended, from its record; ``reason`` in the place of the usual one."""
    return ros.TrialOutcome(
        trial_id=trial_id,
        status=record.status.value,
        reason=reason or _OUTCOME_REASONS[record.status],
        blocks=record.blocks,
        subgoals=record.subgoals,
        action_planning_cost=record.action_planning_cost,
        subgoal_planning_cost=record.subgoal_planning_cost,
        solution_cost=record.solution_cost,
        placements=[placed_to_ros(placed) for placed in record.placements],
    )


def ended_from_ros(message: ros.TrialOutcome) -> TrialEnded:
    """See :class:`TrialEnded`."""
    statuses = [status.value for status in _OUTCOME_REASONS]
    return TrialEnded(message.trial_id, word(TrialStatus, message.status, 'status', statuses))
