"""``stimuli import``: a preview of each tower, and a file that is read back."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from blocks_planning.board.pictures import parse_silhouettes, read_file
from blocks_planning.cli import main


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'gate.json').write_text(json.dumps([[1, 1, 1], [1, 0, 1]]))
    (tmp_path / 'gate.csv').write_text('1,1\n0,1\n')
    return tmp_path


def call(monkeypatch: pytest.MonkeyPatch, *words: str) -> object:
    monkeypatch.setattr(sys, 'argv', ['blocks-planning', 'stimuli', 'import', *words])
    with pytest.raises(SystemExit) as ended:
        main()
    return ended.value.code or 0


def test_towers_are_shown_and_written_and_read_back(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(monkeypatch, 'gate.json', 'gate.csv', '--out', 'towers.txt') == 0
    said = capsys.readouterr().out
    assert '###\n#.#\n=== ground\n' in said
    assert 'tower gate-2, from gate.csv (grid[y][x], y down, true is filled): 2 x 2 cells' in said
    assert said.endswith('towers.txt: 2 towers written\n')
    read = read_file(Path('towers.txt'))
    expected = parse_silhouettes('tower gate\n###\n#.#\n\ntower gate-2\n##\n.#\n', 'x')
    assert read == expected
    assert call(monkeypatch, 'towers.txt', '--out', 'again.txt') == 0
    assert read_file(Path('again.txt')) == expected


def test_without_out_towers_are_only_shown(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    before = sorted(folder.iterdir())
    assert call(monkeypatch, 'gate.json', '--y', 'up', '--true', 'filled') == 0
    assert '#.#\n###\n=== ground\n' in capsys.readouterr().out
    assert sorted(folder.iterdir()) == before


def test_a_file_is_not_written_over_unless_one_says_so(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / 'towers.txt').write_text('mine')
    assert call(monkeypatch, 'gate.json', '--out', 'towers.txt') == 2
    assert '--out towers.txt: the file exists; add --replace' in capsys.readouterr().err
    assert (folder / 'towers.txt').read_text() == 'mine'
    assert call(monkeypatch, 'gate.json', '--out', 'towers.txt', '--replace') == 0
    assert list(read_file(folder / 'towers.txt')) == ['gate']


@pytest.mark.parametrize(
    ('words', 'said'),
    [
        (['nothing.json'], 'nothing.json: cannot be read'),
        (['gate.json', '--out', 'nowhere/x.txt'], '--out nowhere/x.txt: cannot be written'),
        (['gate.json', '--y', 'left'], "'left' is not one of"),
        ([], 'Missing argument'),
    ],
)
def test_what_cannot_be_done_is_refused(
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    words: list[str],
    said: str,
) -> None:
    assert call(monkeypatch, *words) == 2
    assert said in capsys.readouterr().err
