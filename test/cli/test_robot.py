"""A simulated robot that a command cannot have."""

from __future__ import annotations

from pathlib import Path

import pytest
from command import Run
from graphs import write_script

pytest.importorskip('rclpy')
pytest.importorskip(
    'mujoco', reason='the extra robot is not installed: pip install -r requirements/lock-robot.txt'
)


@pytest.mark.parametrize(
    ('world_name', 'options', 'complaint'),
    [
        ('simulated', ['--robot'], 'has world simulated, but --robot expects world observed'),
        ('observed', ['--robot', '--robot-setting', 'glue'], 'expected NAME=VALUE'),
        ('observed', ['--robot', '--robot-setting', 'glue=[1'], 'expected NAME=VALUE'),
        ('observed', ['--robot', '--robot-setting', 'glow=1'], "has no setting 'glow'; it has"),
        ('observed', ['--robot', '--robot-setting', 'cell_m=9'], 'cell_m must be a finite number'),
        ('observed', ['--robot-setting', 'glue=true'], '--robot-setting: expected --robot'),
    ],
)
def test_robot_that_cannot_be(
    run: Run, tmp_path: Path, world_name: str, options: list[str], complaint: str
) -> None:
    script = write_script(tmp_path, worlds=[{'name': world_name}])
    done = run('run', str(script), '--out', str(tmp_path / 'out'), *options)
    assert done.code == 2
    assert complaint in done.err
    assert not (tmp_path / 'out').exists()
