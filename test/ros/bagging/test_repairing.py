"""Bags that are cut off or damaged, repaired or refused."""

from __future__ import annotations

import os
import random
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from bag_builders import (
    SPECS,
    Said,
    add_all,
    contents,
    held_complaints,
    open_bag,
    trial_said,
    write_bag,
)
from mcap.opcode import Opcode

from blocks_planning.ros.bagging import BagError
from blocks_planning.ros.bagging.metadata import FileSummary, RecordedTopic, information
from blocks_planning.ros.bagging.repair import _records, is_finished, repair


def test_what_was_flushed_is_kept(tmp_path: Path, cut_file: Path, said: list[Said]) -> None:
    bag = tmp_path / 'bag'
    bag.mkdir()
    shutil.copy(cut_file, bag)
    [done] = repair(bag)
    kept = len(said) // 9 * 9
    assert done.messages == kept
    assert [data for _, _, data in contents(bag)] == [one.data for one in said[:kept]]
    assert repair(bag) == []
    assert is_finished(bag)


def test_recording_goes_on_in_a_bag_that_was_cut_off(
    tmp_path: Path, cut_file: Path, said: list[Said]
) -> None:
    bag = tmp_path / 'bag'
    bag.mkdir()
    shutil.copy(cut_file, bag)
    kept = len(said) // 9 * 9
    for round_number in (1, 2):
        writer = open_bag(bag)
        assert [done.messages for done in writer.repairs] == [kept if round_number == 1 else 9]
        add_all(writer, said[:9], flush_after=9)
        os.close(writer._lock)  # cut off again
    writer = open_bag(bag)
    writer.close()
    assert sorted(path.name for path in bag.iterdir()) == [
        *(f'bag_{number}.mcap' for number in range(4)),
        'metadata.yaml',
    ]
    assert len(contents(bag)) == kept + 2 * 9


@pytest.mark.parametrize(
    'spoil',
    [
        lambda text: text[:100],
        lambda _: '[' * 5000,
        lambda _: '!!int ""',
        lambda text: text.replace('relative_file_paths:', 'relative_file_paths: 5\n  others:'),
        lambda text: text.replace(
            'relative_file_paths:', f'relative_file_paths: [{"9" * 5000}]\n  x:'
        ),
    ],
    ids=['cut', 'deep', 'no number', 'no list', 'digits'],
)
def test_metadata_alone_is_made_again(
    tmp_path: Path, bag: Path, spoil: Callable[[str], str]
) -> None:
    again = Path(shutil.copytree(bag, tmp_path / 'bag'))
    text = (again / 'metadata.yaml').read_text()
    (again / 'metadata.yaml').write_text(spoil(text))
    assert not is_finished(again)
    assert repair(again) == []
    assert (again / 'metadata.yaml').read_text() == text


@pytest.mark.parametrize(
    ('text', 'said'),
    [('- depth: 1', [{'depth': 1}]), ('', None), ('!!int ""', None), ('[' * 5000, None)],
    ids=['plain', 'empty', 'no number', 'deep'],
)
def test_quality_of_service_that_cannot_be_read_is_left_out(text: str, said: Any) -> None:
    """It stands in the file of a bag, which may be spoilt."""
    topic = RecordedTopic('t', 'std_msgs/msg/String', 'string data', '', text)
    (told,) = information([FileSummary('a.mcap', [topic], {})])['topics_with_message_count']
    assert told['topic_metadata']['offered_qos_profiles'] == (said or [])


def test_any_length_is_repaired_or_refused(tmp_path: Path) -> None:
    """Cut in records, and at, before and after the end of one."""
    _, said = trial_said(SPECS[1])
    datas = [one.data for one in said]
    whole = write_bag(tmp_path / 'whole', said, flush_after=9) / 'whole_0.mcap'
    data = whole.read_bytes()
    with whole.open('rb') as file:
        records = [(opcode, end) for opcode, _, end in _records(file, len(data))]
    ends = {end for opcode, end in records if opcode == Opcode.CHUNK}
    ends |= {end for _, end in records[::4]}
    lengths = {*range(0, 60, 7), *range(0, len(data), 4001), len(data) - 1}
    lengths |= {end + more for end in ends for more in (-1, 0, 1)}
    kept = set()
    for length in sorted(lengths):
        bag = tmp_path / str(length) / 'bag'
        bag.mkdir(parents=True)
        (bag / 'bag_0.mcap').write_bytes(data[:length])
        repair(bag)
        if is_finished(bag):
            found = [content for _, _, content in contents(bag)]
            assert found == datas[: len(found)]
            kept.add(len(found))
        aside = b''.join(path.read_bytes() for path in bag.glob('*.torn'))
        assert data[:length].endswith(aside)
        shutil.rmtree(bag)
    assert kept == {*range(0, len(said), 9), len(said)}


def test_damage_is_repaired_or_refused(tmp_path: Path, cut_file: Path, said: list[Said]) -> None:
    datas = [one.data for one in said]
    whole = cut_file.read_bytes()
    chance = random.Random(5)
    for number in range(100):
        bag = tmp_path / str(number) / 'bag'
        bag.mkdir(parents=True)
        (bag / 'bag_0.mcap').write_bytes(_damaged(whole, chance))
        if _is_repaired(bag, read=number % 10 == 0):
            found = [data for _, _, data in contents(bag)]
            assert found == datas[: len(found)]
        shutil.rmtree(bag)


def test_damaged_finished_bag_is_read_or_refused(tmp_path: Path, bag: Path) -> None:
    whole = (bag / 'bag_0.mcap').read_bytes()
    chance = random.Random(7)
    readable = 0
    for number in range(30):
        damaged = Path(shutil.copytree(bag, tmp_path / str(number) / 'bag'))
        (damaged / 'bag_0.mcap').write_bytes(_damaged(whole, chance))
        readable += _is_repaired(damaged, read=True)
    assert 0 < readable < 30


def _damaged(data: bytes, chance: random.Random) -> bytes:
    damaged = bytearray(data)
    for _ in range(chance.choice((1, 1, 40))):
        damaged[chance.randrange(len(damaged))] ^= 1 << chance.randrange(8)
    return bytes(damaged)


def _is_repaired(bag: Path, *, read: bool) -> bool:
    """Repair a bag, and read its trials; False if that says in one line that it can't be."""
    try:
        repair(bag)
        if read:
            held_complaints(bag)
    except BagError as error:
        refusal = str(error)
    else:
        return True
    assert '\n' not in refusal
    return False


def test_files_of_others_are_not_touched(tmp_path: Path, cut_file: Path) -> None:
    """Another recorder may be writing them."""
    data = cut_file.read_bytes().replace(b'blocks_planning 0', b'libmcap 1.1.0 xyz', 1)
    (tmp_path / 'bag_0.mcap').write_bytes(data)
    with pytest.raises(BagError, match='only files that blocks_planning wrote can be repaired'):
        repair(tmp_path)
    (tmp_path / 'bag_0.mcap').write_bytes(b'#' * 100)
    with pytest.raises(BagError, match='is not an MCAP file'):
        repair(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ['bag_0.mcap']


def test_bag_cut_off_before_anything_was_written(
    tmp_path: Path, said: list[Said], cli: Callable[..., Any]
) -> None:
    """Nothing can be kept; recording goes on all the same."""
    (tmp_path / 'bag_0.mcap').write_bytes(b'\x89MCAP0')
    code, out, err = cli('verify', tmp_path)
    assert (code, err) == (2, f'Error: {tmp_path}: is not a bag that can be read\n')
    assert 'bag_0.mcap: was truncated; kept 0 messages, moved the last 6 bytes' in out
    writer = open_bag(tmp_path)
    add_all(writer, said)
    writer.close()
    assert len(contents(tmp_path)) == len(said)
    assert {path.suffix for path in tmp_path.iterdir()} == {'.mcap', '.torn', '.yaml'}
