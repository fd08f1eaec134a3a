"""The page about the graph says what the graph is."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from blocks_planning_msgs import msg as ros
from source_imports import ROOT

from blocks_planning.ros.wire.conversions.trial import code_of
from blocks_planning.ros.wire.graph import GRAPH
from blocks_planning.ros.wire.topics import TOPICS, VIEW_TOPICS, Topic, ViewTopic
from blocks_planning.trials.messages import PLACEMENT_REASONS, PlacementCode
from blocks_planning.trials.status import TrialStatus

PAGE = (ROOT / 'docs' / 'ros.md').read_text(encoding='utf-8')
MESSAGES = sorted((ROOT / 'msg_defs' / 'msg').glob('*.msg'))
ACTIONS = sorted((ROOT / 'msg_defs' / 'action').glob('*.action'))


def row(first: str) -> list[str]:
    """The cells of the row of a table of topics that begins with a name."""
    topics = PAGE.split('## Topics\n')[1].split('\n## ')[0]
    (found,) = re.findall(rf'^\| `{re.escape(first)}` \| (.*) \|$', topics, re.MULTILINE)
    return [cell.strip() for cell in found.split(' | ')]


def names(cell: str) -> set[str]:
    """The names in a cell."""
    return set(re.findall(r'`([^`]+)`', cell))


@pytest.mark.parametrize('topic', TOPICS, ids=lambda topic: topic.name)
def test_topic_is_told_with_type_qos_and_nodes(topic: Topic) -> None:
    kind, qos, source, listeners = row(topic.name)
    assert names(kind) == {topic.ros_type.__name__}
    assert qos == ('latched' if topic.latched else 'stream')
    assert names(source) == {node.name for node in GRAPH.values() if topic in node.says}
    assert names(listeners) == {node.name for node in GRAPH.values() if topic in node.listens}


@pytest.mark.parametrize('topic', VIEW_TOPICS, ids=lambda topic: topic.name)
def test_topic_for_viewers_is_told(topic: ViewTopic) -> None:
    kind, qos, source, listeners = row(topic.name)
    assert names(kind) == {topic.ros_type.__name__}
    assert qos == 'latched'
    assert names(source) == {node.name for node in GRAPH.values() if topic in node.views}
    assert names(listeners) == {'bag_recorder'}


@pytest.mark.parametrize('path', MESSAGES, ids=lambda path: path.stem)
def test_message_is_told_with_every_field_and_its_comment(path: Path) -> None:
    section = PAGE.split(f'### {path.stem}\n')[1].split('\n##')[0]
    told = re.findall(r'^\| `(\w+)` \| `([^`]+)` \| ?(.*) ?\|$', section, re.MULTILINE)
    defined = [
        (field, kind.removeprefix('std_msgs/'), comment)
        for line in path.read_text(encoding='utf-8').splitlines()
        if '=' not in line.partition('#')[0]
        for kind, field, comment in re.findall(r'^([\w/\[\]]+) (\w+) *(?:# *(.*))?$', line)
    ]
    assert [(field, kind, comment.strip()) for field, kind, comment in told] == defined


@pytest.mark.parametrize('path', ACTIONS, ids=lambda path: path.stem)
def test_action_is_told(path: Path) -> None:
    parts = zip(
        ('goal', 'result', 'feedback'),
        path.read_text(encoding='utf-8').split('\n---\n'),
        strict=True,
    )
    section = PAGE.split(f'### {path.stem} (action)\n')[1].split('\n##')[0]
    told = re.findall(r'^\| (\w+) \| `(\w+)` \| `([^`]+)` \| ?(.*) ?\|$', section, re.MULTILINE)
    defined = [
        (part, field, kind.partition('/')[2] or kind, comment)
        for part, text in parts
        for kind, field, comment in re.findall(
            r'^([\w/\[\]]+) (\w+) *(?:# *(.*))?$', text, re.MULTILINE
        )
    ]
    assert [(*fields, comment.strip()) for *fields, comment in told] == defined


def constants(kind: type) -> dict[str, int]:
    """The CODE constants of a message."""
    return {
        name.removeprefix('CODE_'): getattr(kind, name)
        for name in type(kind).__prepare__(kind.__name__, ())
        if name.startswith('CODE_')
    }


@pytest.mark.parametrize('kind', [ros.PlacementOutcome, ros.TrialOutcome])
def test_codes_are_told_in_one_table(kind: type) -> None:
    section = PAGE.split('### Codes\n')[1].split('\n##')[0]
    rows = re.findall(rf'^\| `{kind.__name__}` \| (\d+) \| `(\w+)` \| \w', section, re.MULTILINE)
    assert {name: int(code) for code, name in rows} == constants(kind)
    assert len(rows) == len(constants(kind)) > 6


def test_codes_of_the_messages_are_those_of_the_package() -> None:
    assert constants(ros.PlacementOutcome) == {code.name: code.value for code in PlacementCode}
    names = {status.name for status in TrialStatus if status is not TrialStatus.BUILDING}
    assert names | {'FAILED', 'REFUSED'} == set(constants(ros.TrialOutcome))
    for status in TrialStatus:
        if status is not TrialStatus.BUILDING:
            assert code_of(status, '') == constants(ros.TrialOutcome)[status.name]
    assert set(PLACEMENT_REASONS) == set(PlacementCode)
