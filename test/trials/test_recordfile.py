"""The file of records: appended to, found again, and left as it was where it cannot be written."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from builders import CHAIR, spec
from disks import disk_of, watch_fsync

from blocks_planning.errors import RecordError
from blocks_planning.search.result import CancelToken
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.recordfile import RecordFile


def records(count: int = 3) -> list[TrialRecord]:
    """Some records."""
    return [run_trial(spec(CHAIR, seed=seed, depth=1, lam=0.1)) for seed in range(count)]


def test_records_are_appended_and_found_again(tmp_path: Path) -> None:
    path = tmp_path / 'deep' / 'trials.jsonl'
    first, second, third = records()
    file = RecordFile(path)
    assert file.finished == set()
    file.append(first)
    assert path.read_text() == first.to_line() + '\n'
    file.append(second)
    assert file.finished == {first.spec.trial_id, second.spec.trial_id}
    file.close()
    again = RecordFile(path)
    assert again.finished == {first.spec.trial_id, second.spec.trial_id}
    again.append(third)
    again.close()
    assert path.read_text().splitlines() == [r.to_line() for r in (first, second, third)]


def test_cancelled_trial_is_not_finished(tmp_path: Path) -> None:
    """It is run again: neither the file that wrote it nor one that reads it counts it."""
    cancel = CancelToken()
    cancel.cancel()
    cancelled = run_trial(spec(CHAIR), cancel)
    file = RecordFile(tmp_path / 'trials.jsonl')
    file.append(cancelled)
    assert file.finished == set()
    file.close()
    again = RecordFile(tmp_path / 'trials.jsonl')
    assert again.finished == set()
    again.close()


def test_record_is_on_disk_before_it_is_appended(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second, _ = records()
    file = RecordFile(tmp_path / 'trials.jsonl')
    file.append(first)
    sizes = watch_fsync(monkeypatch)
    file.append(second)
    assert sizes[-1] == len(first.to_line()) + len(second.to_line()) + 2
    file.close()


@pytest.mark.parametrize('cut', [1, 10, 300, -1])
def test_torn_tail_is_put_aside(cut: int, tmp_path: Path) -> None:
    path = tmp_path / 'trials.jsonl'
    first, second, _ = records()
    torn = second.to_line()[:cut]
    path.write_text(first.to_line() + '\n' + torn)
    file = RecordFile(path)
    assert file.finished == {first.spec.trial_id}
    file.append(second)
    file.close()
    assert path.read_text().splitlines() == [first.to_line(), second.to_line()]
    assert (tmp_path / 'trials.torn').read_text() == torn + '\n'


def test_torn_tails_do_not_replace_each_other(tmp_path: Path) -> None:
    path = tmp_path / 'trials.jsonl'
    for torn in ('{"a', '{"b'):
        path.write_text(torn)
        RecordFile(path).close()
        assert path.read_text() == ''
    assert (tmp_path / 'trials.torn').read_text() == '{"a\n{"b\n'


@pytest.mark.parametrize('line', ['', 'x', '{}', '[]', '1', 'null', '"trial_id"', '[' * 5000])
def test_line_that_is_no_record_is_refused(line: str, tmp_path: Path) -> None:
    path = tmp_path / 'trials.jsonl'
    (first,) = records(1)
    text = f'{first.to_line()}\n{line}\n{first.to_line()}\n'
    path.write_text(text)
    with pytest.raises(RecordError, match=r'trials\.jsonl, line 2: is not a trial record'):
        RecordFile(path)
    assert path.read_text() == text


def test_place_that_can_not_be_written_is_refused(tmp_path: Path) -> None:
    (tmp_path / 'file').write_text('')
    with pytest.raises(RecordError, match=r'trials\.jsonl: cannot be written'):
        RecordFile(tmp_path / 'file' / 'trials.jsonl')
    with pytest.raises(RecordError, match='cannot be written'):
        RecordFile(tmp_path)


def test_records_of_a_file_are_json(tmp_path: Path) -> None:
    path = tmp_path / 'trials.jsonl'
    file = RecordFile(path)
    (first,) = records(1)
    file.append(first)
    file.close()
    assert json.loads(path.read_text()) == first.to_json()


def test_full_disk_leaves_the_records_as_they_were(tmp_path: Path) -> None:
    """However little room there is; and when there is some again it goes on."""
    path = tmp_path / 'trials.jsonl'
    first, second, _ = records()
    file = RecordFile(path)
    file.append(first)
    before = path.read_bytes()
    for room in (0, 1, 100, len(second.to_line())):
        with disk_of(len(before) + room), pytest.raises(RecordError, match='cannot be written'):
            file.append(second)
        assert path.read_bytes() == before
    assert file.finished == {first.spec.trial_id}
    file.append(second)
    file.close()
    assert path.read_text().splitlines() == [first.to_line(), second.to_line()]


def test_one_at_a_time_writes_records(tmp_path: Path) -> None:
    path = tmp_path / 'trials.jsonl'
    file = RecordFile(path)
    with pytest.raises(RecordError, match='another process is writing it'):
        RecordFile(path, wait_s=0)
    file.close()
    RecordFile(path, wait_s=0).close()
