"""Bags on disk: what is written, and where it cannot be."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from bag_builders import START_NS, Said, add_all, contents, held_complaints, open_bag, write_bag
from disks import watch_fsync
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader

from blocks_planning.ros.bagging import BagError
from blocks_planning.ros.bagging.bags import trials_of
from blocks_planning.ros.bagging.definitions import definition_of, type_hash_of
from blocks_planning.ros.bagging.repair import is_finished, repair
from blocks_planning.ros.wire.topics import TOPICS

# What is written


def test_bag_has_every_message_as_it_was(bag: Path, said: list[Said]) -> None:
    expected = [
        (f'/{one.topic.name}', START_NS + number * 1_000_000, one.data)
        for number, one in enumerate(said)
    ]
    with AnyReader([bag]) as reader:
        found = [(entry.topic, time_ns, data) for entry, time_ns, data in reader.messages()]
    assert found == contents(bag) == expected


def test_metadata_is_on_disk_before_it_gets_its_name(
    tmp_path: Path, said: list[Said], monkeypatch: pytest.MonkeyPatch
) -> None:
    sizes = watch_fsync(monkeypatch)
    flushed: list[bool] = []
    replace = Path.replace

    def watched(path: Path, target: Path) -> Path:
        flushed.append(sizes[-1] == path.stat().st_size)
        return replace(path, target)

    monkeypatch.setattr(Path, 'replace', watched)
    write_bag(tmp_path / 'bag', said)
    assert flushed == [True]


def test_mcap_reads_it_too(bag: Path, said: list[Said]) -> None:
    with (bag / 'bag_0.mcap').open('rb') as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        messages = list(reader.iter_decoded_messages())
    assert [m.channel.topic for m in messages] == [f'/{one.topic.name}' for one in said]
    trial = messages[0].decoded_message
    assert bytes(trial.silhouette.cells) == bytes(said[0].message.silhouette.cells)
    assert messages[0].message.publish_time == START_NS - 1000


def test_bag_says_what_rosbag2_says(bag: Path, said: list[Said]) -> None:
    metadata = yaml.safe_load((bag / 'metadata.yaml').read_text())['rosbag2_bagfile_information']
    assert metadata['version'] == 9
    assert metadata['storage_identifier'] == 'mcap'
    assert metadata['relative_file_paths'] == ['bag_0.mcap']
    assert metadata['message_count'] == len(said)
    assert metadata['starting_time']['nanoseconds_since_epoch'] == START_NS
    assert metadata['duration']['nanoseconds'] == (len(said) - 1) * 1_000_000
    with (bag / 'bag_0.mcap').open('rb') as file:
        reader = make_reader(file, validate_crcs=True)
        assert reader.get_header().profile == 'ros2'
        [inside] = reader.iter_metadata()
        summary = reader.get_summary()
        assert sum(1 for _ in reader.iter_messages()) == len(said)
    text = inside.metadata['serialized_metadata']
    assert inside.name == 'rosbag2'
    assert yaml.safe_load(text) == metadata
    assert summary is not None
    topics = {
        entry['topic_metadata']['name']: entry for entry in metadata['topics_with_message_count']
    }
    assert len(summary.channels) == len(TOPICS)
    for channel in summary.channels.values():
        entry = topics[channel.topic]['topic_metadata']
        assert channel.message_encoding == entry['serialization_format'] == 'cdr'
        assert channel.metadata['topic_type_hash'] == entry['type_description_hash']
        offered = yaml.safe_load(channel.metadata['offered_qos_profiles'])
        assert offered == entry['offered_qos_profiles']
        assert summary.schemas[channel.schema_id].encoding == 'ros2msg'
    assert offered[0] | {
        'deadline': None,
        'lifespan': None,
        'liveliness_lease_duration': None,
    } == {
        'history': 'keep_last',
        'depth': 1,
        'reliability': 'reliable',
        'durability': 'transient_local',
        'deadline': None,
        'lifespan': None,
        'liveliness': 'automatic',
        'liveliness_lease_duration': None,
        'avoid_ros_namespace_conventions': False,
    }


@pytest.mark.parametrize('topic', TOPICS, ids=lambda topic: topic.name)
def test_definition_is_whole_and_has_its_comments(topic: Any, bag: Path) -> None:
    ros_type = f'blocks_planning_msgs/msg/{topic.ros_type.__name__}'
    with AnyReader([bag]) as reader:
        [connection] = [c for c in reader.connections if c.topic == f'/{topic.name}']
        assert (
            connection.digest == type_hash_of(ros_type) == reader.typestore.hash_rihs01(ros_type)
        )
    text = definition_of(ros_type)
    assert connection.msgdef.data == text
    assert text.startswith('# ')
    assert (
        text.count('MSG: std_msgs/Header\n') == text.count('MSG: builtin_interfaces/Time\n') == 1
    )


def test_file_is_split(tmp_path: Path, said: list[Said]) -> None:
    writer = open_bag(tmp_path / 'bag', split_bytes=6000)
    for number, one in enumerate(said):
        if writer.add(f'/{one.topic.name}', one.data, START_NS + number, 0):
            writer.flush()
    writer.close()
    files = sorted((tmp_path / 'bag').glob('*.mcap'))
    assert len(files) > 2
    assert [data for _, _, data in contents(tmp_path / 'bag')] == [one.data for one in said]
    for file in files:
        assert list(trials_of(file)) is not None
        assert is_finished(file)
    assert held_complaints(tmp_path / 'bag') == []


def test_bag_without_messages(tmp_path: Path, cli: Callable[..., Any]) -> None:
    write_bag(tmp_path / 'bag', [])
    assert contents(tmp_path / 'bag') == []
    assert list(trials_of(tmp_path / 'bag')) == []
    assert cli('verify', tmp_path / 'bag')[0] == 0
    code, _, err = cli('draw', tmp_path / 'bag', '--out', tmp_path / 'x.png')
    assert (code, err) == (2, f'Error: {tmp_path / "bag"}: has no trial\n')


# Where it can't be written


def test_finished_bag_is_refused(bag: Path) -> None:
    with pytest.raises(BagError, match='contains a finished bag'):
        open_bag(bag)


def test_other_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / 'thesis.tex').touch()
    with pytest.raises(BagError, match='contains something that is not a bag'):
        open_bag(tmp_path)
    with pytest.raises(BagError, match='cannot be written: File exists'):
        open_bag(tmp_path / 'thesis.tex')


def test_bag_that_is_being_recorded_is_left_alone(tmp_path: Path, said: list[Said]) -> None:
    writer = open_bag(tmp_path / 'bag')
    add_all(writer, said[:5], flush_after=2)
    for touch in (open_bag, repair):
        with pytest.raises(BagError, match='another process is recording it'):
            touch(tmp_path / 'bag')
    with pytest.raises(BagError, match='another process is recording it'):
        repair(tmp_path / 'bag' / 'bag_0.mcap')
    with pytest.raises(BagError, match='is truncated'):
        list(trials_of(tmp_path / 'bag'))
    writer.close()
    assert len(contents(tmp_path / 'bag')) == 5


def test_full_disk_loses_nothing_if_there_is_room_again(
    tmp_path: Path, said: list[Said], monkeypatch: pytest.MonkeyPatch
) -> None:
    writer = open_bag(tmp_path / 'bag')
    add_all(writer, said[:10])
    writer.flush()
    file = tmp_path / 'bag' / 'bag_0.mcap'
    before = file.read_bytes()
    write = os.write
    with monkeypatch.context() as full:
        full.setattr(os, 'write', lambda descriptor, data: _full(descriptor, data, write))
        add_all(writer, said[10:20])
        for _ in range(2):
            with pytest.raises(OSError, match='No space left'):
                writer.flush()
            assert file.read_bytes() == before
        add_all(writer, said[20:30])
    writer.flush()
    add_all(writer, said[30:])
    writer.close()
    assert [data for _, _, data in contents(tmp_path / 'bag')] == [one.data for one in said]


def test_disk_that_stays_full_keeps_what_was_written(
    tmp_path: Path, said: list[Said], monkeypatch: pytest.MonkeyPatch
) -> None:
    writer = open_bag(tmp_path / 'bag')
    add_all(writer, said[:10])
    writer.flush()
    write = os.write
    with monkeypatch.context() as full:
        full.setattr(os, 'write', lambda descriptor, data: _full(descriptor, data, write))
        add_all(writer, said[10:])
        with pytest.raises(OSError, match='No space left'):
            writer.close()
    assert not is_finished(tmp_path / 'bag')
    [done] = repair(tmp_path / 'bag')
    assert (done.messages, done.aside_bytes) == (10, 0)
    assert [data for _, _, data in contents(tmp_path / 'bag')] == [one.data for one in said[:10]]


def test_memory_is_bounded_while_the_disk_is_full(
    tmp_path: Path, said: list[Said], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr('blocks_planning.ros.bagging.writer.MOST_WAITING_BYTES', 2000)
    writer = open_bag(tmp_path / 'bag')
    add_all(writer, said)
    assert 0 < writer.lost < len(said)
    assert writer.lost + writer.counts.total() == len(said)
    writer.close()
    assert len(contents(tmp_path / 'bag')) == writer.counts.total()


def _full(descriptor: int, data: Any, write: Callable[[int, Any], int]) -> int:
    """Take some bytes, as a disk does that is nearly full, and no more."""
    write(descriptor, data[:7])
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
