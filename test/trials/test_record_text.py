"""What is no record, or no file of records, is refused in one line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from sample_record import CANDIDATE, LINE, SAMPLE, after_place, changed, refused

from blocks_planning.errors import RecordError
from blocks_planning.trials.reading import read_records


@pytest.mark.parametrize('end', [1, 2, 100, len(LINE) // 2, len(LINE) - 1])
def test_cut_line_is_refused(tmp_path: Path, end: int) -> None:
    assert refused(tmp_path, LINE[:end]).startswith(': is not JSON: ')


@pytest.mark.parametrize(
    'text', ['words', '{,}', "{'a': 1}", '{} {}', 'nul', '"', '\\', '\x00', '\ufeff{}']
)
def test_what_is_no_json_is_refused(tmp_path: Path, text: str) -> None:
    assert refused(tmp_path, text).startswith(': is not JSON: ')


@pytest.mark.parametrize('text', ['null', '1', '"x"', '[]', 'true', '[{}]'])
def test_what_is_no_object_is_refused(tmp_path: Path, text: str) -> None:
    assert refused(tmp_path, text) == f': expected an object, got {text}'


def test_deep_nesting_is_refused(tmp_path: Path) -> None:
    for depth in (2, 10, *range(800, 1010, 3), 5000, 100_000):
        nested = '[' * depth + ']' * depth
        refused(tmp_path, nested)
        for path in (
            ('stimulus',),
            ('silhouette',),
            ('strategy_settings', 'lambda'),
            ('search_settings', 'depth'),
            ('decisions',),
            (*CANDIDATE, 'regions'),
            ('extra',),
        ):
            refused(tmp_path, json.dumps(changed(path, 'HERE')).replace('"HERE"', nested))


def test_record_that_is_laid_out_is_refused_by_file_and_key(tmp_path: Path) -> None:
    path = tmp_path / 'record.json'
    for data, words in (
        (changed((*CANDIDATE, 'cells'), -1), 'decisions[0], candidates[1]: cells must'),
        (changed(('blocks',), 7000), 'blocks contradicts'),
    ):
        path.write_text(json.dumps(data, indent=2))
        with pytest.raises(RecordError) as caught:
            read_records(path)
        assert words in after_place(caught.value, str(path))
    path.write_text(json.dumps(SAMPLE, indent=2)[:200])
    with pytest.raises(RecordError, match='is not JSON'):
        read_records(path)


@pytest.mark.parametrize('data', [b'', b'\n', b' \r\n\t\n'])
def test_file_without_records_is_refused(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / 'empty.json'
    path.write_bytes(data)
    with pytest.raises(RecordError) as caught:
        read_records(path)
    assert after_place(caught.value, str(path)) == ': is empty, expected trial records'


def test_file_that_cannot_be_read_is_refused(tmp_path: Path) -> None:
    loop, binary = tmp_path / 'loop', tmp_path / 'binary'
    loop.symlink_to(loop)
    binary.write_bytes(b'{}\n\x80\x81')
    for path, words in (
        (tmp_path, 'cannot be read: Is a directory'),
        (tmp_path / 'missing.json', 'cannot be read: No such file or directory'),
        (loop, 'cannot be read: Too many levels of symbolic links'),
        (tmp_path / ('x' * 300), 'cannot be read: File name too long'),
        (binary, 'is not a text file (byte 3)'),
    ):
        with pytest.raises(RecordError) as caught:
            read_records(path)
        assert after_place(caught.value, str(path)) == f': {words}'


def test_path_with_a_nul_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RecordError):
        read_records(tmp_path / 'a\0b')
