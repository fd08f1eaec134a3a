"""The whole graph as processes, brought up by ``blocks-planning run``."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import time
from pathlib import Path
from typing import Any

import pytest
from graphs import (
    bring_up,
    is_alive,
    local_lines,
    node_processes,
    record_lines,
    run_graph,
    run_in_terminal,
    wait_until,
    write_script,
)
from peers import Graph, Peer
from rclpy.node import Node
from rosbags.highlevel import AnyReader

from blocks_planning.ros.bagging.bags import trials_of
from blocks_planning.ros.runtime.domain import Domain
from blocks_planning.ros.wire.topics import MARKERS, STATE, TOPICS, TRIAL, Topic
from blocks_planning.trials.reading import read_records
from blocks_planning.trials.script import read_script
from blocks_planning.trials.verify import contradictions

NODES = {'world', 'subgoal_selector', 'action_searcher', 'trial_orchestrator'}
STOP_BOUND_S = 6.0
"""Every node ends within a second, the bring-up within two more; the machine may be busy."""
MANY: dict[str, Any] = {
    'stimuli': ['cogsci2021'],
    'searches': [{'name': 'bfs', 'depth': 3}],
    'strategies': [{'name': 'scoping', 'lambda': [0.0, 0.002]}],
    'seeds': 20,
}
"""More trials than a test has time for."""


def lines(out: Path) -> int:
    """How many records there are."""
    return len(record_lines(out))


def test_script_runs_to_its_end_and_is_not_run_again(tmp_path: Path) -> None:
    script, out = write_script(tmp_path, seeds=3), tmp_path / 'out'
    done = run_graph(script, '--out', out, '--bag', tmp_path / 'bag')
    assert done.returncode == 0, done.stderr
    assert record_lines(out) == local_lines(script)
    assert 'Traceback' not in done.stderr
    assert 'trial 3 of 3' in done.stderr
    assert '3 of 3 trials' in done.stdout
    assert f'Pictures: {out}/pictures\n' in done.stdout
    assert len(list((out / 'pictures').iterdir())) == 3
    assert (tmp_path / 'bag' / 'metadata.yaml').exists()

    before = (out / 'trials.jsonl').stat().st_mtime_ns
    again = run_graph(script, '--out', out)
    assert again.returncode == 0, again.stderr
    assert (out / 'trials.jsonl').stat().st_mtime_ns == before
    assert '3 of 3 trials' in again.stdout
    assert 'trial 1 of 3' not in again.stderr


def test_terminal_shows_the_tower_while_it_is_built(tmp_path: Path) -> None:
    code, shown = run_in_terminal(write_script(tmp_path), '--out', tmp_path, '--pace', 0.4)
    assert code == 0
    assert '▶' in shown  # the chosen candidate
    assert '┌' in shown  # a block that stands


@pytest.mark.long
def test_markers_are_shown_and_recorded_when_asked_for(graph: Graph, tmp_path: Path) -> None:
    """They reach who listens on the domain, and a bag from which the trials can be rebuilt."""
    script, out, bag = write_script(tmp_path, seeds=3), tmp_path / 'out', tmp_path / 'bag'
    shown: list[Any] = []
    graph.add(lambda **options: Node('viewer', **options), namespace='/').create_subscription(
        MARKERS.ros_type, MARKERS.name, shown.append, MARKERS.subscription_qos
    )
    domain = os.environ['ROS_DOMAIN_ID']
    arguments = ('--out', out, '--bag', bag, '--domain', domain, '--pace', '0.1', '--markers')
    with bring_up(script, *arguments, '--no-pictures') as process:
        graph.spin_until(lambda: process.poll() is not None, deadline_s=60)
    assert process.returncode == 0
    assert not (out / 'pictures').exists()
    assert record_lines(out) == local_lines(script)
    assert [trial.record.to_line() for trial in trials_of(bag)] == local_lines(script)
    with AnyReader([bag]) as reader:
        [connection] = [one for one in reader.connections if one.topic == '/markers']
    assert connection.msgcount > 3
    assert len(shown) > 3
    assert {one.ns for one in shown[-1].markers} >= {'ground', 'silhouette', 'blocks', 'text'}


@pytest.mark.long
def test_many_trials_are_drawn_only_when_asked_for_and_only_the_first(tmp_path: Path) -> None:
    script, out = write_script(tmp_path, seeds=17), tmp_path / 'out'
    done = run_graph(script, '--out', out)
    assert done.returncode == 0, done.stderr
    assert 'Pictures' not in done.stdout
    assert not (out / 'pictures').exists()

    again = run_graph(script, '--out', out, '--pictures')
    assert f'Pictures: {out}/pictures (of the first 16 trials; 1 left out)' in again.stdout
    names = {f'cogsci2021-5-scoping-bfs-seed{seed}.svg' for seed in range(16)}
    assert {path.name for path in (out / 'pictures').iterdir()} == names


def test_exit_code_says_that_a_tower_was_not_rebuilt(tmp_path: Path) -> None:
    towers = tmp_path / 'towers.txt'
    towers.write_text('#...\n##..\n####\n####\n', encoding='utf-8')
    script = write_script(tmp_path, stimuli=[str(towers)])
    done = run_graph(script, '--out', tmp_path / 'out')
    assert done.returncode == 1, done.stderr
    assert record_lines(tmp_path / 'out') == local_lines(script)


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM], ids=['SIGINT', 'SIGTERM'])
@pytest.mark.parametrize('moment', range(2))
def test_interrupted_at_any_moment_it_leaves_nothing_behind(
    number: signal.Signals, moment: int, tmp_path: Path
) -> None:
    """Once while it starts, once in the middle; and what is on disk is whole."""
    chance = random.Random(f'{number}-{moment}')
    script, out = write_script(tmp_path, **MANY), tmp_path / 'out'
    trials = chance.randint(1, 6) if moment else 0
    with bring_up(script, '--out', out) as process:
        if moment:
            wait_until(process, lambda: lines(out) >= trials)
        else:
            wait_until(process, lambda: len(node_processes(process.pid)) == len(NODES))
        with_delay(process, chance.uniform(0, 0.3))
        pids = node_processes(process.pid)
        assert set(pids) == NODES
        asked = time.monotonic()
        process.send_signal(number)
        _, err = process.communicate(timeout=STOP_BOUND_S * 2)
        assert time.monotonic() - asked < STOP_BOUND_S
    assert process.returncode == 130
    assert 'Traceback' not in err
    assert not [name for name, pid in pids.items() if is_alive(pid)]
    specs = read_script(script)
    written = record_lines(out)
    assert len(written) >= trials
    if written:
        records = read_records(out / 'trials.jsonl')
        assert [record.spec for record in records] == specs[: len(written)]
        assert not [c for record in records for c in contradictions(record)]


def with_delay(process: subprocess.Popen[str], delay_s: float) -> None:
    """Let a process run for a while; it must not end."""
    with pytest.raises(subprocess.TimeoutExpired):
        process.wait(delay_s)


def test_goes_on_where_it_was_interrupted(tmp_path: Path) -> None:
    script, out = write_script(tmp_path, stimuli=['cogsci2021'], seeds=1), tmp_path / 'out'
    with bring_up(script, '--out', out) as process:
        wait_until(process, lambda: lines(out) >= 3)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=STOP_BOUND_S * 2)
    before = record_lines(out)
    assert 3 <= len(before) <= 16
    done = run_graph(script, '--out', out)
    assert done.returncode in (0, 1), done.stderr
    after = record_lines(out)
    assert after[: len(before)] == before
    assert after == local_lines(script)


@pytest.mark.parametrize(
    'name',
    ['world', *(pytest.param(name, marks=pytest.mark.long) for name in sorted(NODES - {'world'}))],
)
def test_node_that_dies_comes_back_and_nothing_is_lost(name: str, tmp_path: Path) -> None:
    script, out = write_script(tmp_path, seeds=9), tmp_path / 'out'
    with bring_up(script, '--out', out) as process:
        wait_until(process, lambda: lines(out) >= 2)
        os.kill(node_processes(process.pid)[name], signal.SIGKILL)
        _, err = process.communicate(timeout=60)
    assert process.returncode in (0, 1), err
    assert record_lines(out) == local_lines(script)


def test_nodes_end_when_their_bring_up_is_killed(tmp_path: Path) -> None:
    script, out = write_script(tmp_path, **MANY), tmp_path / 'out'
    with bring_up(script, '--out', out) as process:
        wait_until(process, lambda: lines(out) >= 1)
        pids = node_processes(process.pid)
        assert set(pids) == NODES
        process.kill()
        process.wait()
        deadline = time.monotonic() + STOP_BOUND_S
        while any(map(is_alive, pids.values())):
            assert time.monotonic() < deadline, f'still there: {pids}'
            time.sleep(0.02)  # they are no children of this process: nothing to wait for
    read_records(out / 'trials.jsonl')


@pytest.mark.long
def test_two_at_once_do_not_hear_each_other(tmp_path: Path) -> None:
    folders = [tmp_path / 'one', tmp_path / 'two']
    scripts = []
    for seed, folder in enumerate(folders):
        folder.mkdir()
        scripts.append(write_script(folder, seeds=6, first_seed=100 * seed))
    with (
        bring_up(scripts[0], '--out', folders[0]) as first,
        bring_up(scripts[1], '--out', folders[1]) as second,
    ):
        ends = [process.communicate(timeout=60) for process in (first, second)]
    assert (first.returncode, second.returncode) == (0, 0), ends
    for folder, script in zip(folders, scripts, strict=True):
        assert record_lines(folder) == local_lines(script)


def listeners(node: Node, topic: Topic) -> set[str]:
    """The names of the nodes that subscribe to a topic in the namespace of a node."""
    name = f'{node.get_namespace()}/{topic.name}'
    return {one.node_name for one in node.get_subscriptions_info_by_topic(name)}


@pytest.mark.long
def test_namespace_and_domain_are_where_it_was_told(graph: Graph, tmp_path: Path) -> None:
    """A peer in that namespace of that domain hears every trial.

    Nothing is drawn, so the bring-up itself hears of no state.
    """
    script, out = write_script(tmp_path, seeds=2), tmp_path / 'out'
    specs = read_script(script)
    namespace = '/some/where'
    peer = graph.add(Peer, specs[0], (), TOPICS, namespace=namespace)
    domain = os.environ['ROS_DOMAIN_ID']
    with bring_up(script, '--out', out, '--namespace', namespace, '--domain', domain) as process:
        graph.spin_until(lambda: 'subgoal_selector' in listeners(peer, STATE), deadline_s=60)
        assert 'watcher' not in listeners(peer, STATE)
        graph.spin_until(lambda: process.poll() is not None, deadline_s=60)
    assert process.returncode == 0
    started = [message.spec for message in peer.only(TRIAL.kind)]
    assert started[-1] == specs[-1]
    assert record_lines(out) == local_lines(script)


@pytest.mark.parametrize(
    ('keys', 'said'),
    [
        ({'colour': 'red'}, "line 1, key 'colour': unknown key"),
        ({'seeds': 0}, "key 'seeds'"),
        ({'strategies': [{'name': 'luck'}]}, "strategy must be one of .*, got 'luck'"),
    ],
)
def test_bad_script_is_refused_before_anything_starts(
    keys: dict[str, Any], said: str, tmp_path: Path
) -> None:
    script = write_script(tmp_path, **keys)
    done = run_graph(script, '--out', tmp_path / 'out')
    assert (done.returncode, done.stdout) == (2, '')
    assert len(done.stderr.splitlines()) == 1
    assert str(script) in done.stderr
    assert not (tmp_path / 'out').exists()


@pytest.mark.parametrize('domain', ['-1', '101'])
def test_impossible_domain_is_refused(domain: str, tmp_path: Path) -> None:
    done = run_graph(write_script(tmp_path), '--out', tmp_path / 'out', '--domain', domain)
    assert done.returncode == 2
    assert 'domain must be from 0 to 100' in done.stderr


def test_domains_are_claimed_until_they_are_released() -> None:
    domains = [Domain() for _ in range(5)]
    assert len({domain.number for domain in domains} | {int(os.environ['ROS_DOMAIN_ID'])}) == 6
    for domain in domains:
        domain.release()


@pytest.mark.long
def test_watcher_counts_what_it_saw(tmp_path: Path) -> None:
    """Progress is said for every trial, with its outcome."""
    script = write_script(tmp_path, seeds=2, strategies=[{'name': 'none'}])
    done = run_graph(script, '--out', tmp_path / 'out')
    records = [json.loads(line) for line in record_lines(tmp_path / 'out')]
    said = [line for line in done.stderr.splitlines() if line.startswith('trial ')]
    assert len(said) == len(records) == 2
    for line, record in zip(said, records, strict=True):
        assert f'{record["stimulus"]}: {record["status"]}' in line
        assert f'{record["blocks"]} blocks' in line
