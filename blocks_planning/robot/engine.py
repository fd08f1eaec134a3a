"""Whether MuJoCo is there. It is an extra: everything else of the package works without it."""

from __future__ import annotations

from importlib.util import find_spec

from blocks_planning.errors import ConfigurationError


def why_missing() -> str:
    """Why the robot cannot be simulated here, and what to do; '' if it can."""
    if find_spec('mujoco') is None:
        return (
            'the robot needs MuJoCo, which is not installed: '
            'pip install -r requirements/robot.in, or install blocks_planning[robot]'
        )
    return ''


def check_installed() -> None:
    """Refuse to go on without MuJoCo.

    Raises:
        ConfigurationError: with the way to install it.
    """
    reason = why_missing()
    if reason:
        raise ConfigurationError(reason)
