"""Which nodes are present, as the middleware learns of them: endpoints first, names later."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest
from rclpy.node import Node

from blocks_planning.ros.runtime.peers import _FRESH_S, Peers
from blocks_planning.ros.wire.graph import GRAPH

NAMESPACE = '/lab'
UNKNOWN = '_NODE_NAME_UNKNOWN_'


class Seen:
    """A node that sees the endpoints of one other node, and counts how often it lists them."""

    def __init__(self, other: str) -> None:
        topics = GRAPH[other]
        self.name, self.listings = other, 0
        ends = [(True, topic.name) for topic in topics.says]
        ends += [(True, topic.name) for topic in topics.views]
        ends += [(False, topic.name) for topic in topics.listens]
        self._ends = {end: number for number, end in enumerate(ends)}

    def count_publishers(self, topic: str) -> int:
        return (True, topic) in self._ends

    def count_subscribers(self, topic: str) -> int:
        return (False, topic) in self._ends

    def resolve_topic_name(self, topic: str) -> str:
        return topic

    def get_namespace(self) -> str:
        return NAMESPACE

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        return [(self.name, NAMESPACE)]

    def get_publishers_info_by_topic(self, topic: str) -> list[Any]:
        return self._infos(True, topic)

    def get_subscriptions_info_by_topic(self, topic: str) -> list[Any]:
        self.listings += 1
        return self._infos(False, topic)

    def _infos(self, says: bool, topic: str) -> list[Any]:
        if (says, topic) not in self._ends:
            return []
        gid = [self._ends[says, topic]]
        space = NAMESPACE if self.name != UNKNOWN else UNKNOWN
        return [SimpleNamespace(endpoint_gid=gid, node_name=self.name, node_namespace=space)]


@pytest.fixture
def still(monkeypatch: pytest.MonkeyPatch) -> None:
    """No time passes."""
    monkeypatch.setattr('blocks_planning.ros.runtime.peers.time.monotonic', lambda: 10 * _FRESH_S)


@pytest.mark.usefixtures('still')
@pytest.mark.parametrize('name', GRAPH)
def test_a_node_is_present_as_soon_as_its_name_is_known(name: str) -> None:
    seen = Seen(name)
    peers = Peers(cast(Node, seen))
    seen.name = UNKNOWN
    assert peers.missing([name]) == [name]
    seen.name = name
    assert peers.missing([name]) == []


@pytest.mark.usefixtures('still')
def test_endpoints_with_names_are_listed_once() -> None:
    seen = Seen('world')
    peers = Peers(cast(Node, seen))
    peers.missing(['world'])
    first = seen.listings
    peers.missing(['world'])
    assert seen.listings == first > 0
