"""Options for a simulated robot."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib import import_module
from pathlib import Path

import yaml

from blocks_planning.errors import ConfigurationError
from blocks_planning.robot.settings import RobotSettings
from blocks_planning.settings import Value, build, settings_of
from blocks_planning.trials.spec import TrialSpec


def robot_for(
    specs: Iterable[TrialSpec], script: Path, is_wanted: bool, given: Iterable[str]
) -> dict[str, Value] | None:
    """The settings of the robot; None if no robot is wanted.

    Args:
        specs: trials that it will build.
        script: in which they are.
        is_wanted: whether a robot is wanted.
        given: settings as NAME=VALUE.

    Raises:
        ConfigurationError: for a setting that it does not have, settings without a robot, or a
            trial whose world carries out the orders itself.
        MissingExtra: if the simulation is not installed.
    """
    values = dict(_read(given))
    if not is_wanted:
        if values:
            raise ConfigurationError('--robot-setting: expected --robot beside it')
        return None
    import_module('blocks_planning.robot.robot')
    for spec in specs:
        if spec.world.simulates:
            raise ConfigurationError(
                f'{script}: trial {spec.trial_id} has world {spec.world.name}, but --robot expects '
                'world observed: write "worlds: [{name: observed}]" in the script'
            )
    return dict(settings_of(build('robot', RobotSettings, values)))


def _read(given: Iterable[str]) -> Iterator[tuple[str, object]]:
    for text in given:
        name, sign, value = text.partition('=')
        try:
            read = yaml.safe_load(value)
        except yaml.YAMLError:
            sign = ''
        if not sign:
            raise ConfigurationError(
                f'--robot-setting: expected NAME=VALUE such as glue=false, got {text!r}'
            )
        yield name, read
