"""The journal of the world, without a world."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest
from disks import disk_of, watch_fsync

from blocks_planning.board.blocks import Block, Placed, Placement
from blocks_planning.errors import RecordError
from blocks_planning.ros.runtime.journal import MOST_KEPT, Journal
from blocks_planning.worlds.observation import Observation

SEEN = [
    Observation(Placement(Block(2, 1), 1), (Placed(2, 1, 0, 0),)),
    Observation(
        None,
        (Placed(1, 16, 15, 0), Placed(1, 1, 3, 0)),
        (Placed(2, 1, 0, 0), Placed(1, 1, 2, 0)),
    ),
    Observation(Placement(Block(4, 2), 3)),
]


def journal_of(folder: Path, trial_id: str = 'a') -> Path:
    """The file of a journal with all observations, as a world leaves it that was killed."""
    journal = Journal(folder)
    assert journal.begin(trial_id) == ([], '')
    for seen in SEEN:
        journal.append(seen)
    journal.release()
    (path,) = folder.glob('*.journal')
    return path


def begin(folder: Path, trial_id: str = 'a') -> tuple[list[Observation], str]:
    """What a world that is started again finds."""
    journal = Journal(folder)
    found = journal.begin(trial_id)
    journal.release()
    return found


def test_what_was_written_is_there_again(tmp_path: Path) -> None:
    journal_of(tmp_path)
    assert begin(tmp_path) == (SEEN, '')


def test_every_observation_is_on_disk_when_the_disk_is_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sizes = watch_fsync(monkeypatch)
    path = journal_of(tmp_path)
    assert path.stat().st_size in sizes


def test_name_of_a_new_journal_is_on_disk_when_the_disk_is_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else a power cut could lose a file whose content is on disk."""
    names: list[list[str]] = []

    def watched(descriptor: int) -> None:
        if stat.S_ISDIR(os.fstat(descriptor).st_mode):
            names.append(os.listdir(descriptor))

    monkeypatch.setattr(os, 'fsync', watched)
    path = journal_of(tmp_path)
    assert [path.name] in names


def test_journal_that_goes_on_is_on_disk_before_it_replaces_the_old_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    size = journal_of(tmp_path).stat().st_size
    sizes = watch_fsync(monkeypatch)
    flushed_before: list[list[int]] = []
    replace = Path.replace

    def watched(path: Path, target: Path) -> Path:
        flushed_before.append(list(sizes))
        return replace(path, target)

    monkeypatch.setattr(Path, 'replace', watched)
    begin(tmp_path)
    assert flushed_before == [[size]]


def test_version_1_is_read_and_goes_on_as_version_2(tmp_path: Path) -> None:
    path = journal_of(tmp_path)
    path.write_bytes(b'blocks_planning/journal 1\n2 1 0 0\n1 16 15 0\n4 2')
    kept = [Observation(p.placement, (p,)) for p in (Placed(2, 1, 0, 0), Placed(1, 16, 15, 0))]
    again = Journal(tmp_path)
    assert again.begin('a') == (kept, '')
    again.append(SEEN[1])
    again.release()
    assert begin(tmp_path) == ([*kept, SEEN[1]], '')


def test_another_trial_begins_empty_and_costs_the_first_nothing(tmp_path: Path) -> None:
    journal_of(tmp_path)
    again = Journal(tmp_path)
    assert again.begin('b') == ([], '')
    assert again.begin('a') == (SEEN, '')


@pytest.mark.parametrize('cut', range(1, 8))
def test_a_torn_last_line_is_forgotten_and_the_rest_goes_on(tmp_path: Path, cut: int) -> None:
    path = journal_of(tmp_path)
    path.write_bytes(path.read_bytes()[:-cut])
    again = Journal(tmp_path)
    assert again.begin('a') == (SEEN[:-1], '')
    again.append(SEEN[-1])
    again.release()
    assert begin(tmp_path) == (SEEN, '')


@pytest.mark.parametrize(
    'content', [b'', b'\n', b'\x00\xff', b'something else\n1 1 0 0\n', b'{"trial": 1}\n']
)
def test_what_is_no_journal_is_set_aside(tmp_path: Path, content: bytes) -> None:
    path = journal_of(tmp_path)
    path.write_bytes(content)
    observations, warning = begin(tmp_path)
    assert observations == []
    assert 'is not a journal; it was renamed to' in warning
    (aside,) = tmp_path.glob('*.aside-*')
    assert aside.read_bytes() == content


def test_a_bad_line_in_the_middle_sets_the_file_aside(tmp_path: Path) -> None:
    path = journal_of(tmp_path)
    path.write_bytes(path.read_bytes().replace(b'1 16 15 0', b'1 16 x 0'))
    observations, warning = begin(tmp_path)
    assert (observations, bool(warning)) == ([], True)


def test_no_trial_id_leads_out_of_the_folder(tmp_path: Path) -> None:
    folder = tmp_path / 'journals'
    journal_of(folder, '../../etc/' + 'x' * 300)
    assert [path.name for path in tmp_path.iterdir()] == ['journals']


def test_a_trial_that_is_over_needs_no_journal(tmp_path: Path) -> None:
    journal = Journal(tmp_path)
    journal.begin('a')
    journal.append(SEEN[0])
    journal.end()
    assert list(tmp_path.iterdir()) == []


def test_nothing_that_was_set_aside_is_overwritten(tmp_path: Path) -> None:
    path = journal_of(tmp_path)
    for content in (b'one', b'two'):
        path.write_bytes(content)
        begin(tmp_path)
    assert {aside.read_bytes() for aside in tmp_path.glob('*.aside-*')} == {b'one', b'two'}


def test_a_journal_that_can_not_be_right_is_set_aside(tmp_path: Path) -> None:
    path = journal_of(tmp_path)
    content = path.read_bytes()
    journal = Journal(tmp_path)
    journal.begin('a')
    assert 'it was renamed to' in journal.refuse()
    journal.append(SEEN[1])
    journal.release()
    (aside,) = tmp_path.glob('*.aside-*')
    assert aside.read_bytes() == content
    assert begin(tmp_path) == (SEEN[1:2], '')


def test_a_full_disk_leaves_the_journal_as_it_was(tmp_path: Path) -> None:
    """However little room there is; and when there is some again it goes on."""
    path = journal_of(tmp_path)
    before = path.read_bytes()
    journal = Journal(tmp_path)
    journal.begin('a')
    for room in range(len(b'4 2 3;;\n')):
        with disk_of(len(before) + room), pytest.raises(RecordError, match='cannot be written'):
            journal.append(SEEN[2])
        assert path.read_bytes() == before
    journal.append(SEEN[2])
    journal.release()
    assert begin(tmp_path) == ([*SEEN, SEEN[2]], '')


def test_a_full_disk_begins_no_journal(tmp_path: Path) -> None:
    journal = Journal(tmp_path)
    with disk_of(3):
        assert journal.begin('a') == ([], '')
        with pytest.raises(RecordError, match='cannot be written'):
            journal.append(SEEN[0])
    journal.append(SEEN[0])
    journal.release()
    assert begin(tmp_path) == (SEEN[:1], '')


def test_one_at_a_time_writes_in_a_folder(tmp_path: Path) -> None:
    first = Journal(tmp_path)
    with pytest.raises(RecordError, match='another process is writing it'):
        Journal(tmp_path, wait_s=0)
    first.release()
    Journal(tmp_path, wait_s=0)


def test_a_folder_that_cannot_be_made_is_refused(tmp_path: Path) -> None:
    (tmp_path / 'file').write_text('')
    with pytest.raises(RecordError, match='cannot be written'):
        Journal(tmp_path / 'file' / 'journals')


def test_every_trial_id_has_a_journal_of_its_own(tmp_path: Path) -> None:
    for first, second in (('a/b', 'a_b'), ('x' * 250 + 'a', 'x' * 250 + 'b')):
        journal = Journal(tmp_path)
        journal.begin(first)
        journal.append(SEEN[0])
        assert journal.begin(second) == ([], '')
        assert journal.begin(first) == (SEEN[:1], '')
        journal.release()


def test_trials_that_come_and_go_leave_no_heap_of_files(tmp_path: Path) -> None:
    journal = Journal(tmp_path)
    for number in range(100):
        journal.begin(f'nothing was placed in {number}')
    assert list(tmp_path.iterdir()) == []
    for number in range(3 * MOST_KEPT):
        journal.begin(str(number))
        journal.append(SEEN[0])
    assert len(list(tmp_path.iterdir())) <= MOST_KEPT + 1
    assert journal.begin(str(3 * MOST_KEPT - 1)) == (SEEN[:1], '')
