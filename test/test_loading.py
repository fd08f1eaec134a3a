"""What an import loads: nothing that only some commands need."""

from __future__ import annotations

import subprocess
import sys

import pytest
from declared import NAMES
from source_imports import PACKAGE


def loaded_by(module: str) -> set[str]:
    """Every module that is loaded once a module has been imported."""
    code = f'import sys, {module}; print(*sys.modules)'
    command = [sys.executable, '-c', code]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return set(done.stdout.split())


@pytest.fixture(scope='module')
def loaded() -> set[str]:
    """What ``import blocks_planning`` loads."""
    return loaded_by(PACKAGE)


@pytest.fixture(scope='module')
def loaded_by_commands() -> set[str]:
    """What each command loads before it is chosen."""
    return loaded_by(f'{PACKAGE}.cli')


@pytest.mark.parametrize('heavy', [*sorted(NAMES), 'rclpy'])
def test_importing_the_package_is_instant(loaded: set[str], heavy: str) -> None:
    assert PACKAGE in loaded
    assert heavy not in loaded


@pytest.mark.parametrize('heavy', [*sorted(NAMES.keys() - {'click', 'numpy', 'yaml'}), 'rclpy'])
def test_a_command_does_not_wait_for_what_others_need(
    loaded_by_commands: set[str], heavy: str
) -> None:
    assert f'{PACKAGE}.cli' in loaded_by_commands
    assert heavy not in loaded_by_commands
