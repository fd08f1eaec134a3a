"""The commands of studies: what they print, and their exit codes."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner
from source_imports import ROOT

from blocks_planning.cli import commands
from blocks_planning.errors import ConfigurationError
from blocks_planning.study.desk import Desk
from blocks_planning.study.spec import read_study

EXAMPLE = ROOT / 'config' / 'studies' / 'example.yaml'


def run(*words: str | Path) -> str:
    done = CliRunner().invoke(commands, ['study', *map(str, words)], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return done.output


@pytest.mark.parametrize('words', [('missing.yaml', '--out', 'x'), ('--out', 'x', 'missing.yaml')])
def test_a_file_instead_of_a_command_is_served(words: tuple[str, ...], tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=r'missing\.yaml'):
        run(*(tmp_path / word if word != '--out' else word for word in words))


def test_export_tells_what_it_wrote(tmp_path: Path) -> None:
    desk = Desk(read_study(EXAMPLE), tmp_path / 'out')
    desk.begin('P01')
    said = run('export', tmp_path / 'out', '--out', tmp_path / 'tables')
    assert f'{tmp_path / "tables" / "participants.csv"}: 1 rows' in said
    assert f'{tmp_path / "tables" / "trials.csv"}: 0 rows' in said
    assert not (tmp_path / 'tables' / 'records').exists()
    desk.release()


def test_help_names_both() -> None:
    assert 'export' in run('--help')
    assert 'STUDY.yaml' in run('serve', '--help')
