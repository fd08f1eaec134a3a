"""``blocks-planning verify`` on bags."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest


def test_verify_repairs_and_says_so(
    tmp_path: Path, cut_file: Path, cli: Callable[..., Any]
) -> None:
    bag = tmp_path / 'bag'
    bag.mkdir()
    (bag / 'bag_0.mcap').write_bytes(cut_file.read_bytes() + b'\x06\xff')
    code, _, err = cli('draw', bag, '--out', tmp_path / 'x.gif')
    assert code == 2
    assert err.endswith(f'is truncated; `blocks-planning verify {bag}` repairs it\n')
    code, out, _ = cli('verify', bag)
    assert code == 0
    assert 'was truncated; kept' in out
    assert 'moved the last 2 bytes to bag_0.mcap.torn' in out
    assert cli('draw', bag, '--record', 2, '--out', tmp_path / 'x.gif')[0] == 0
    assert (tmp_path / 'x.gif').read_bytes().startswith(b'GIF89a')


def test_verify_takes_files_of_a_bag(bag: Path, tmp_path: Path, cli: Callable[..., Any]) -> None:
    file = Path(shutil.copy(bag / 'bag_0.mcap', tmp_path))
    assert cli('verify', file, '--rerun') == (0, f'{file}: 5 records read\nall consistent\n', '')
    file.write_bytes(file.read_bytes()[:-1])
    code, out, _ = cli('verify', file)
    assert code == 0
    assert '5 records read' in out


@pytest.mark.parametrize('make', ['missing.mcap', 'empty', 'text.mcap'])
def test_what_is_no_bag_takes_one_line(make: str, tmp_path: Path, cli: Callable[..., Any]) -> None:
    path = tmp_path / make
    if make == 'empty':
        path.mkdir()
    elif make == 'text.mcap':
        path.write_text('this is no bag, and it has more characters than a header')
    code, out, err = cli('verify', path)
    assert (code, out) == (2, '')
    assert err.startswith(f'Error: {path}: ')
    assert err.count('\n') == 1


@pytest.mark.parametrize('missing', ['blocks_planning_msgs', 'rosbags', 'mcap'])
def test_without_ros_one_line_says_what_is_missing(missing: str, bag: Path) -> None:
    code = (
        f'import sys; sys.modules[{missing!r}] = None; sys.argv[1:] = ["verify", {str(bag)!r}];'
        'from blocks_planning.cli import main; main()'
    )
    done = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, timeout=60)
    expected = f'Error: {bag}: this is a bag; reading it needs {missing}, which is not installed\n'
    assert (done.returncode, done.stdout, done.stderr) == (2, '', expected)


def test_reading_needs_no_middleware(bag: Path) -> None:
    code = (
        'import sys; from pathlib import Path; from blocks_planning.ros.bagging.bags import trials_of;'
        f'assert list(trials_of(Path({str(bag)!r})));'
        'assert "rclpy" not in sys.modules'
    )
    subprocess.run([sys.executable, '-c', code], check=True, timeout=60)
