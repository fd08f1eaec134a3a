"""Bags on disk: what is written, cut off, damaged, repaired, read back and held against itself."""

from __future__ import annotations

import copy
import errno
import os
import random
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from bag_builders import (
    START_NS,
    Said,
    add_all,
    changed_bag,
    contents,
    open_bag,
    said_of,
    trial_said,
    write_bag,
)
from builders import CHAIR, NEVER_SOLVED, ODD, SQUARE, cancelled_record, ended, spec
from mcap.opcode import Opcode
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader

from blocks_planning.cli import main
from blocks_planning.ros.bagging import BagError
from blocks_planning.ros.bagging.bags import RecordedTrial, trials_of
from blocks_planning.ros.bagging.definitions import definition_of, type_hash_of
from blocks_planning.ros.bagging.metadata import FileSummary, RecordedTopic, information
from blocks_planning.ros.bagging.repair import _records, is_finished, repair
from blocks_planning.ros.wire.topics import OUTCOME, STATE, SUBGOAL, TOPICS, TRIAL
from blocks_planning.search.result import CancelToken
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus

SPECS = [
    spec(SQUARE, stimulus='square', search='bfs', depth=1),
    spec(CHAIR, stimulus='chair'),
    spec(CHAIR, stimulus='chair', strategy='full', lam=0.5, search='random'),
    spec(ODD, stimulus='odd', strategy='none', search='exact'),
    spec(NEVER_SOLVED, stimulus='never'),
]


@pytest.fixture(scope='module')
def trials() -> list[tuple[TrialRecord, list[Said]]]:
    return [trial_said(one) for one in SPECS]


@pytest.fixture(scope='module')
def said(trials: list[tuple[TrialRecord, list[Said]]]) -> list[Said]:
    return [one for _, messages in trials for one in messages]


@pytest.fixture(scope='module')
def bag(said: list[Said], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished bag of all trials."""
    return write_bag(tmp_path_factory.mktemp('bags') / 'bag', said, flush_after=9)


@pytest.fixture(scope='module')
def cut_file(said: list[Said], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The file of a bag whose writer vanished."""
    path = tmp_path_factory.mktemp('cut') / 'bag'
    writer = open_bag(path)
    add_all(writer, said, flush_after=9)
    os.close(writer._lock)
    return path / 'bag_0.mcap'


@pytest.fixture
def cli(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., Any]:
    """Calls the command in this process; returns exit code, stdout and stderr."""

    def call(*arguments: object) -> tuple[object, str, str]:
        monkeypatch.setattr(sys, 'argv', ['blocks-planning', *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            main()
        return (ended.value.code or 0, *capsys.readouterr())

    return call


def held_complaints(bag: Path) -> list[str]:
    refused: list[str] = []
    found = [
        sentence for one in trials_of(bag, refused.append) for sentence in one.contradictions()
    ]
    return refused + found


def only_trial(bag: Path) -> RecordedTrial:
    [trial] = trials_of(bag)
    return trial


# What is written


def test_bag_has_every_message_as_it_was(bag: Path, said: list[Said]) -> None:
    expected = [
        (f'/{one.topic.name}', START_NS + number * 1_000_000, one.data)
        for number, one in enumerate(said)
    ]
    with AnyReader([bag]) as reader:
        found = [(entry.topic, time_ns, data) for entry, time_ns, data in reader.messages()]
    assert found == contents(bag) == expected


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


# Cut off


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


# Read back


def test_records_are_made_from_the_bag_alone(
    bag: Path, trials: list[tuple[TrialRecord, list[Said]]]
) -> None:
    found = list(trials_of(bag))
    assert [one.record for one in found] == [record for record, _ in trials]
    assert [one.record.to_line() for one in found] == [record.to_line() for record, _ in trials]
    assert {record.status for record, _ in trials} >= {TrialStatus.SUCCESS, TrialStatus.GAVE_UP}
    assert held_complaints(bag) == []


def test_topics_need_no_order_among_each_other(
    tmp_path: Path, said: list[Said], trials: list[tuple[TrialRecord, list[Said]]]
) -> None:
    order = [OUTCOME, STATE, SUBGOAL, TRIAL]
    rank = {topic: order.index(topic) if topic in order else 9 for topic in TOPICS}
    shuffled = [one for _, some in trials for one in sorted(some, key=lambda one: rank[one.topic])]
    bag = write_bag(tmp_path / 'bag', shuffled)
    assert [one.record for one in trials_of(bag)] == [record for record, _ in trials]
    assert held_complaints(bag) == []


def test_many_trials_are_read_one_by_one(tmp_path: Path) -> None:
    pairs = [trial_said(spec(SQUARE, seed=seed)) for seed in range(30)]
    bag = write_bag(tmp_path / 'bag', [one for _, some in pairs for one in some])
    assert [one.record for one in trials_of(bag)] == [record for record, _ in pairs]
    assert held_complaints(bag) == []


def test_trial_that_the_bag_does_not_see_the_end_of(
    tmp_path: Path, cli: Callable[..., Any]
) -> None:
    record, said = trial_said(spec(CHAIR))
    last = max(n for n, one in enumerate(said) if one.topic is STATE)
    bag = write_bag(tmp_path / 'bag', said[:last])
    trial = only_trial(bag)
    assert not trial.is_over
    assert trial.outcome is None
    assert trial.record.placements == record.placements[:-1]
    assert list(trial.contradictions()) == []
    code, out, _ = cli('verify', bag, '--rerun')
    assert code == 0
    assert "record 1 ('small'): its end is not in the bag" in out
    assert cli('draw', bag, '--out', tmp_path / 'x.gif')[0] == 0


def test_tower_that_stood_before_its_decisions_is_no_contradiction(tmp_path: Path) -> None:
    """A world that was started again has its journal; the recorder went before the rest came."""
    _, said = trial_said(spec(CHAIR))
    states = [one for one in said if one.topic is STATE]
    bag = write_bag(tmp_path / 'bag', [said[0], states[-1]])
    trial = only_trial(bag)
    assert trial.outcome is None
    assert list(trial.contradictions()) == []


def test_states_that_were_missed_do_not_matter(tmp_path: Path) -> None:
    """A recorder that was away, and came back, hears the latest of everything."""
    record, said = trial_said(spec(CHAIR))
    last = {
        topic: max(n for n, o in enumerate(said) if o.topic is topic) for topic in (STATE, SUBGOAL)
    }
    kept = [o for n, o in enumerate(said) if n >= last.get(o.topic, 0)]
    trial = only_trial(write_bag(tmp_path / 'bag', kept))
    assert trial.record == record
    assert list(trial.contradictions()) == []


def test_subgoals_that_were_missed_are_named(tmp_path: Path) -> None:
    """Nobody says them again when the next trial has begun."""
    _, said = trial_said(spec(CHAIR))
    bag = write_bag(tmp_path / 'bag', [one for one in said if one.topic is not SUBGOAL])
    [sentence] = only_trial(bag).contradictions()
    assert sentence.startswith("the outcome has status 'success', but the bag lacks")


@pytest.mark.parametrize('after', range(0, 24, 3))
def test_cancelled_trial(tmp_path: Path, after: int) -> None:
    """What the other parts still did when the trial was cancelled is not in its record."""
    trial = spec(CHAIR)
    record = cancelled_record(trial, after + 1)
    heard: list[Message] = []
    run_trial(trial, CancelToken(), heard.append)
    over = ended(trial.trial_id, record)
    for extra in (0, 1, 5):
        said = said_of(trial, [*heard[: after + 1 + extra], over])
        found = only_trial(write_bag(tmp_path / f'bag{extra}', said))
        if record.status is TrialStatus.CANCELLED:
            assert found.record == record
        assert list(found.contradictions()) == []


# Lies


def _as_stuck(outcome: Any) -> None:
    outcome.status = 'stuck'
    outcome.code = outcome.CODE_STUCK


LIES: dict[str, Callable[[Any], object]] = {
    'status': _as_stuck,
    'blocks': lambda outcome: setattr(outcome, 'blocks', outcome.blocks + 1),
    'subgoals': lambda outcome: setattr(outcome, 'subgoals', outcome.subgoals + 1),
    'action_planning_cost': lambda outcome: setattr(outcome, 'action_planning_cost', 1),
    'subgoal_planning_cost': lambda outcome: setattr(outcome, 'subgoal_planning_cost', 2),
    'solution_cost': lambda outcome: setattr(outcome, 'solution_cost', 3),
    'orders': lambda outcome: setattr(outcome, 'orders', outcome.orders + 1),
    'surprises': lambda outcome: setattr(outcome, 'surprises', 1),
    'f1': lambda outcome: setattr(outcome, 'f1', 0.5),
    'placements': lambda outcome: outcome.placements.reverse(),
}


@pytest.mark.parametrize('name', LIES)
def test_lie_about_the_outcome_is_found(
    name: str, tmp_path: Path, bag: Path, cli: Callable[..., Any]
) -> None:
    victim = SPECS[1].trial_id

    def lie(one: Said) -> Said:
        if one.topic is OUTCOME and one.message.trial_id == victim:
            LIES[name](one.message)
        return one

    code, out, err = cli('verify', changed_bag(bag, tmp_path / 'bag', lie))
    assert (code, err) == (1, '')
    [sentence] = [line for line in out.splitlines() if "record 2 ('chair')" in line]
    assert f'the outcome has {name} ' in sentence
    assert out.splitlines()[-1] == '1 inconsistent'


def test_cancelling_is_no_way_to_hide_success(tmp_path: Path, bag: Path) -> None:
    def lie(one: Said) -> Said:
        if one.topic is OUTCOME:
            one.message.status = 'cancelled'
            one.message.code = one.message.CODE_CANCELLED
        return one

    assert any(
        "status 'cancelled'" in s for s in held_complaints(changed_bag(bag, tmp_path / 'b', lie))
    )


def test_lie_about_a_cost_is_found(tmp_path: Path, bag: Path) -> None:
    def lie(one: Said) -> Said:
        if one.topic is SUBGOAL:
            for decision in one.message.decisions:
                decision.subgoal_planning_cost += 1
        return one

    assert held_complaints(changed_bag(bag, tmp_path / 'bag', lie))


def test_state_that_cannot_be_is_named(tmp_path: Path, bag: Path, cli: Callable[..., Any]) -> None:
    def lie(one: Said) -> Said:
        if one.topic is STATE and one.message.sequence == 2:
            one.message.placements[1].row += 1
        return one

    code, out, _ = cli('verify', changed_bag(bag, tmp_path / 'bag', lie))
    assert code == 1
    assert 'a WorldState of trial' in out
    assert 'was refused: placements[1]' in out


def test_outcome_of_nothing_is_named(tmp_path: Path, bag: Path, cli: Callable[..., Any]) -> None:
    code, out, _ = cli(
        'verify',
        changed_bag(bag, tmp_path / 'bag', lambda one: None if one.topic is TRIAL else one),
    )
    assert code == 1
    assert out.count('ended, but was never announced') == len(SPECS)


# The command


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


# A recorder that was killed, and started again later


def with_absence(path: Path, said: list[Said], gone: int, back: int, seed: int) -> Path:
    """A bag whose recorder was killed before a message, and was there again before another.

    It then finds one topic after the other, and hears what is latched there.
    """
    chance = random.Random(seed)
    found = {topic: back + chance.randrange(30) * (seed % 3) for topic in TOPICS}
    again = []
    for place, one in enumerate(said[back:], start=back):
        for topic in (topic for topic in TOPICS if found[topic] == place and topic.latched):
            again += [earlier for earlier in said[:place] if earlier.topic is topic][-1:]
        if place >= found[one.topic]:
            again.append(one)
    time_ns = START_NS
    for part in (said[:gone], again):
        writer = open_bag(path)
        for one in part:
            time_ns += 1_000_000
            writer.add(f'/{one.topic.name}', one.data, time_ns, time_ns)
        writer.flush()
        os.close(writer._lock)
    repair(path)
    return path


@pytest.mark.parametrize('seed', range(16))
def test_absence_of_the_recorder_is_no_contradiction(
    seed: int, said: list[Said], trials: list[tuple[TrialRecord, list[Said]]], tmp_path: Path
) -> None:
    """And of the trials that it was there for nothing is lost."""
    chance = random.Random(seed)
    gone = chance.randrange(1, len(said) - 1) if seed else 0
    back = chance.randrange(gone, len(said))
    bag = with_absence(tmp_path / 'bag', said, gone, back, seed)
    refused: list[str] = []
    found = list(trials_of(bag, refused.append))
    assert refused == []
    assert [list(one.contradictions()) for one in found] == [[] for _ in found]
    ended = {one.record.to_line() for one in found if one.is_over}
    at = 0
    for record, messages in trials:
        if at + len(messages) <= gone or at >= back + 60:
            assert record.to_line() in ended
        at += len(messages)


def test_absence_hides_no_lie(said: list[Said], tmp_path: Path, bag: Path) -> None:
    """What is there of a trial must still be what its outcome says."""
    outcome = next(n for n, one in enumerate(said) if one.topic is OUTCOME)
    states = [n for n, one in enumerate(said[:outcome]) if one.topic is STATE]

    def lie(one: Said) -> Said:
        if one.topic is OUTCOME and one.message.placements:
            one.message.placements[0].column ^= 2
        return one

    told = [lie(Said(one.topic, copy.deepcopy(one.message))) for one in said]
    found = with_absence(tmp_path / 'bag', told, states[-2] + 1, outcome, 0)
    first = next(iter(trials_of(found)))
    assert any('placements' in sentence for sentence in first.contradictions())
