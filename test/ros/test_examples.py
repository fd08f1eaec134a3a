"""The examples of the documentation, in a whole graph."""

from __future__ import annotations

import os
import runpy
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from blocks_planning_msgs import msg
from graphs import NODES, record_lines, write_script
from source_imports import ROOT

from blocks_planning.ros.runtime.domain import Domain
from blocks_planning.trials.reading import read_records
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions

EXAMPLES = {
    'custom_searcher': ('action_searcher', 'my_searcher'),
    'custom_selector': ('subgoal_selector', 'my_selector'),
    'fake_robot': ('world', 'fake_robot'),
}
"""Each with the node that it stands in for, and its own name."""
STRATEGIES: dict[str, list[dict[str, Any]]] = {
    'subgoal_selector': [{'name': 'scoping'}, {'name': 'full'}],
    'my_selector': [{'name': 'external', 'program': program} for program in ('one', 'two')],
}
SEARCHES: dict[str, list[dict[str, Any]]] = {
    'action_searcher': [{'name': 'bfs', 'depth': 3}],
    'my_searcher': [{'name': 'external', 'program': 'large_blocks_first'}],
}
_BOUND_S = 240
"""For five processes to start, and for four trials."""


@contextmanager
def process(
    command: list[str], environment: dict[str, str], log: Path
) -> Iterator[subprocess.Popen[bytes]]:
    """A process that gets a SIGTERM in the end, and has a second to take it."""
    with log.open('wb') as stderr:
        running = subprocess.Popen(command, env=environment, stderr=stderr)
    try:
        yield running
    finally:
        running.send_signal(signal.SIGTERM)
        try:
            running.wait(5)
        except subprocess.TimeoutExpired:
            running.kill()
            running.wait()
    assert [line for line in log.read_text().splitlines() if not line.startswith('[INFO]')] == []
    assert running.returncode == 0


@pytest.mark.parametrize(
    'examples',
    [[*EXAMPLES], *(pytest.param([name], marks=pytest.mark.long) for name in EXAMPLES)],
    ids='+'.join,
)
def test_example_takes_the_place_of_a_node(examples: list[str], tmp_path: Path) -> None:
    nodes = {name: name for name in ('world', 'subgoal_selector', 'action_searcher')}
    commands = {name: ['-m', NODES, name] for name in nodes}
    for example in examples:
        replaced, nodes[replaced] = EXAMPLES[example][0], EXAMPLES[example][1]
        commands[replaced] = [str(ROOT / 'docs' / 'examples' / f'{example}.py')]
    script = write_script(
        tmp_path,
        stimuli=['cogsci2021/5', 'cogsci2021/14'],
        strategies=STRATEGIES[nodes['subgoal_selector']],
        searches=SEARCHES[nodes['action_searcher']],
    )
    commands['trial_orchestrator'] = [
        *('-m', NODES, 'trial_orchestrator', '--ros-args'),
        *('-p', f'script:={script}', '-p', f'out_dir:={tmp_path}'),
        *('-p', f'wait_for:=[{", ".join(nodes.values())}]'),
    ]
    domain = Domain()
    environment = domain.environment(os.environ)
    with ExitStack() as stack:
        for name, command in commands.items():
            running = stack.enter_context(
                process([sys.executable, *command], environment, tmp_path / f'{name}.log')
            )
        assert running.wait(_BOUND_S) == 0
    domain.release()
    records = read_records(tmp_path / 'trials.jsonl')
    assert len(records) == len(record_lines(tmp_path)) == 4
    for record in records:
        assert record.status is TrialStatus.SUCCESS
        assert list(contradictions(record)) == []


@pytest.mark.parametrize(
    ('hold', 'orders'),
    [
        ({}, 1),
        ({'trial_id': 't', 'is_held': False, 'sequence': 0}, 1),
        ({'trial_id': 't', 'is_held': True, 'sequence': 4}, 1),
        ({'trial_id': 't', 'is_held': True, 'sequence': 3}, 0),
        ({'trial_id': 'another', 'is_held': True, 'sequence': 3}, 1),
    ],
    ids=['silent', 'free', 'later', 'now', 'another'],
)
def test_custom_searcher_gives_no_order_that_is_held(hold: dict[str, Any], orders: int) -> None:
    act = runpy.run_path(str(ROOT / 'docs/examples/custom_searcher.py'))['MySearcher'].act
    block = msg.Placement(block=msg.Block(width=2, height=1), column=5, row=1)
    chosen = msg.PlannedSubgoal(execute=1, placements=[block])
    decision = msg.Decision(subgoals=[chosen], executed=1)
    given: list[Any] = []
    act(
        SimpleNamespace(action=SimpleNamespace(publish=given.append)),
        msg.TrialSpec(trial_id='t'),
        msg.WorldState(trial_id='t', sequence=3),
        msg.Subgoal(trial_id='t', sequence=3, decisions=[decision]),
        msg.Hold(**hold),
    )
    assert [(one.sequence, one.column) for one in given] == [(3, 5)] * orders


@pytest.mark.parametrize('example', [*EXAMPLES, 'clumsy_arm'])
def test_example_is_short_and_printed_in_the_documentation(example: str) -> None:
    path = ROOT / 'docs' / 'examples' / f'{example}.py'
    code = [line for line in path.read_text(encoding='utf-8').splitlines() if line.strip()]
    assert len(code) <= 70
    assert f'examples/{example}.py' in (ROOT / 'docs' / 'ros.md').read_text(encoding='utf-8')
