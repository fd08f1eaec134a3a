"""Settings of the members of a trial, as names and typed values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from blocks_planning_msgs import msg as ros

from blocks_planning.errors import InvalidInput
from blocks_planning.families import Registry
from blocks_planning.ros.wire.conversions.fields import MessageError, bounded, refuse
from blocks_planning.settings import Value, settings_of
from blocks_planning.trials.spec import FAMILIES, TrialSpec

MOST_SETTINGS = 64
_FIELDS: dict[type, tuple[int, str]] = {
    bool: (ros.Setting.TYPE_BOOL, 'bool_value'),
    int: (ros.Setting.TYPE_INTEGER, 'integer_value'),
    float: (ros.Setting.TYPE_DOUBLE, 'double_value'),
    str: (ros.Setting.TYPE_STRING, 'string_value'),
}
_FIELD_OF = dict(_FIELDS.values())


def settings_to_ros(values: Mapping[str, Value]) -> list[ros.Setting]:
    """Settings by name, each with a value of its own type."""
    found = []
    for name, value in values.items():
        number, field = _FIELDS[type(value)]
        found.append(ros.Setting(name=name, type=number, **{field: value}))
    return found


def settings_from_ros(messages: Sequence[ros.Setting], field: str) -> dict[str, Value]:
    """Settings by name. Whether a member has them, and accepts their values, is not checked."""
    bounded(messages, field, 0, MOST_SETTINGS)
    values: dict[str, Value] = {}
    for index, message in enumerate(messages):
        place = f'{field}[{index}]'
        if message.name in values:
            raise refuse(f'{place}.name', message.name, 'each setting once')
        if message.type not in _FIELD_OF:
            raise refuse(f'{place}.type', message.type, f'a type from 1 to {max(_FIELD_OF)}')
        values[message.name] = getattr(message, _FIELD_OF[message.type])
    return values


def planner_to_ros(spec: TrialSpec) -> ros.PlannerConfig:
    """The member of each family that a trial names, with all of its settings."""
    config = ros.PlannerConfig(budget=spec.budget)
    for family in FAMILIES:
        chosen = getattr(spec, family)
        setattr(config, family, chosen.name)
        setattr(config, f'{family}_settings', settings_to_ros(settings_of(chosen)))
    return config


def members_from_ros(message: ros.PlannerConfig) -> dict[str, object]:
    """The members that a trial names, by family."""
    return {family: _member(message, family, registry) for family, registry in FAMILIES.items()}


def _member(message: ros.PlannerConfig, family: str, registry: Registry) -> object:
    field = f'planner.{family}_settings'
    values = settings_from_ros(getattr(message, f'{family}_settings'), field)
    try:
        return registry.make(getattr(message, family), values)
    except InvalidInput as error:
        raise MessageError(f'planner.{family}: {error}') from None
