"""The recorder as a process that is stopped, killed and started."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest
from bag_builders import Said, flushed
from peers import Graph
from recorders import COMMAND, DEADLINE_S, Peer, add_recorder, expected, recorded, recorder, stop

from blocks_planning.ros.bagging import BagError
from blocks_planning.ros.bagging.bags import trials_of
from blocks_planning.ros.bagging.repair import is_finished, repair
from blocks_planning.ros.wire.topics import TRIAL


@pytest.mark.parametrize('number', [signal.SIGTERM, signal.SIGINT])
def test_stopped_recorder_finishes_its_bag(
    number: signal.Signals, graph: Graph, peer: Peer, said: list[Said], tmp_path: Path
) -> None:
    bag = tmp_path / 'bag'
    with recorder(graph, bag, '-p', 'split_bytes:=5000') as process:
        peer.wait_for_listeners()
        peer.say(said)
        graph.spin_until(lambda: flushed(bag) == len(said))
        code, printed = stop(process, number)
        assert code == 0
        assert [line for line in printed.splitlines() if not line.startswith('[INFO]')] == []
    assert is_finished(bag)
    assert recorded(bag) == expected(graph, said)
    assert len(list(bag.glob('*.mcap'))) > 1


@pytest.mark.long
def test_killed_recorder_loses_what_was_not_flushed_and_goes_on(
    graph: Graph, peer: Peer, said: list[Said], tmp_path: Path
) -> None:
    bag = tmp_path / 'bag'
    half = len(said) // 2
    with recorder(graph, bag) as process:
        peer.wait_for_listeners()
        peer.say(said[:half])
        graph.spin_until(lambda: flushed(bag) == half)
        process.kill()
        process.wait()
    assert not is_finished(bag)
    peer.wait_for_listeners(0)
    with recorder(graph, bag) as process:
        peer.wait_for_listeners()
        latched = {one.topic: one for one in said[:half] if one.topic.latched}
        graph.spin_until(lambda: flushed(bag) == half + len(latched))
        peer.say(said[half:])
        graph.spin_until(lambda: flushed(bag) == len(said) + len(latched))
        code, err = stop(process, signal.SIGTERM)
    assert code == 0
    assert f'bag_0.mcap: was truncated; kept {half} messages' in err
    again = [one for one in said[:half] if latched.get(one.topic) is one]
    assert recorded(bag) == expected(graph, [*said[:half], *again, *said[half:]])
    assert [list(one.contradictions()) for one in trials_of(bag)] == [[], []]


def test_killed_recorder_is_repaired_without_a_graph(
    graph: Graph, peer: Peer, said: list[Said], tmp_path: Path
) -> None:
    bag = tmp_path / 'bag'
    with recorder(graph, bag) as process:
        peer.wait_for_listeners()
        peer.say(said)
        graph.spin_until(lambda: flushed(bag) == len(said))
        with pytest.raises(BagError, match='another process is recording it'):
            repair(bag)
        process.kill()
        process.wait()
    [done] = repair(bag)
    assert (done.messages, done.aside_bytes) == (len(said), 0)
    assert recorded(bag) == expected(graph, said)


def test_finished_bag_ends_the_process_with_one_line(graph: Graph, tmp_path: Path) -> None:
    bag = tmp_path / 'bag'
    add_recorder(graph, bag).finish()
    with recorder(graph, bag) as process:
        _, err = process.communicate(timeout=DEADLINE_S)
    assert process.returncode == 2
    assert err == f'Error: {bag}: contains a finished bag; choose a new folder\n'


def test_full_disk_is_said_once_and_survived(
    graph: Graph, peer: Peer, said: list[Said], tmp_path: Path
) -> None:
    """A limit of 64 KiB on every file stands for the disk."""
    bag = tmp_path / 'bag'
    [outcome] = [one for one in said[-1:] if one.topic.name == 'outcome']
    limited = ['bash', '-c', 'ulimit -f 64; exec "$@"', 'bash', *COMMAND]
    with recorder(graph, bag, command=limited) as process:
        peer.wait_for_listeners()
        peer.say(said)
        graph.spin_until(lambda: flushed(bag) == len(said))
        for _ in range(100):
            outcome.message.reason = os.urandom(1000).hex()
            peer.say([Said(outcome.topic, outcome.message)])
        os.set_blocking(process.stderr.fileno(), False)  # type: ignore[union-attr]
        told = ''

        def has_told() -> bool:
            nonlocal told
            told += process.stderr.read() or ''  # type: ignore[union-attr]
            return 'cannot be written' in told

        graph.spin_until(has_told)
        before = flushed(bag)
        assert len(said) <= before < len(said) + 100
        peer.say([Said(TRIAL, said[0].message)])
        os.set_blocking(process.stderr.fileno(), True)  # type: ignore[union-attr]
        code, err = stop(process, signal.SIGTERM)
    assert code == 0
    assert (told + err).count('cannot be written: File too large') == 1
    assert 'Traceback' not in told + err
    assert 'cannot be finished: File too large' in err
    assert [done.messages for done in repair(bag)] == [before]
    assert len(list(trials_of(bag, lambda _: None))) == 2
