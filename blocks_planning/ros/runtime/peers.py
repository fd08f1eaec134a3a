"""The other nodes of the graph: present and missing."""

from __future__ import annotations

import time
from collections import OrderedDict, defaultdict
from collections.abc import Iterable
from typing import Any, NamedTuple

from rclpy.node import Node

from blocks_planning.ros.wire.graph import GRAPH, NodeTopics
from blocks_planning.ros.wire.topics import PROPOSAL, TOPICS, VIEW_TOPICS, Topic, ViewTopic

_UNKNOWN = '_NODE_NAME_UNKNOWN_'
_MOST_NAMES = 10_000
_FRESH_S = 5.0


class Around(NamedTuple):
    """The nodes at the other ends of a node's topics.

    Attributes:
        present: names of the present nodes, in order.
        missing: names of the nodes of this package for topics without a publisher.
    """

    present: list[str]
    missing: list[str]


class Peers:
    """The other nodes of a node's namespace.

    The middleware finds the publishers and subscriptions of a node before it learns its name. If a
    node was stopped for longer than its lease and then continues, they are found again, but not the
    name. So the name of each endpoint is kept.
    """

    def __init__(self, node: Node) -> None:
        """Start without information."""
        self._node = node
        self._names: OrderedDict[bytes, tuple[str, str]] = OrderedDict()
        self._counts: list[int] = []
        self._listed_s = 0.0
        self._all_named = False
        self._listed: defaultdict[str, set[_End]] = defaultdict(set)

    def missing(self, names: Iterable[str]) -> list[str]:
        """The nodes that are not present with all of their topics.

        For a node from another package only the name is checked.
        """
        ends, space = self._ends(), self._node.get_namespace()
        alive = {name for name, at in self._node.get_node_names_and_namespaces() if at == space}
        return [
            name
            for name in names
            if (name not in alive and name not in ends) or not _wanted(name) <= ends[name]
        ]

    def around(self, topics: NodeTopics) -> Around:
        """The nodes at the other ends of a node's topics."""
        heard = {_End(True, topic.name) for topic in topics.listens}
        sought = heard | {_End(False, topic.name) for topic in topics.says}
        ends = self._ends()
        unsaid = heard.difference(*ends.values()) - _NOT_ALWAYS_SAID
        present = sorted(name for name in ends if name != topics.name and ends[name] & sought)
        missing = [name for name in GRAPH if name not in present and _wanted(name) & unsaid]
        return Around(present, missing)

    def _ends(self) -> defaultdict[str, set[_End]]:
        """The endpoints of each node.

        Listing them takes milliseconds, counting them far less: they are listed again when their
        number has changed, while one has no name yet, and every ``_FRESH_S``.
        """
        counts = [
            count(topic.name)
            for topic in (*TOPICS, *VIEW_TOPICS)
            for count in (self._node.count_publishers, self._node.count_subscribers)
        ]
        now_s = time.monotonic()
        is_fresh = counts == self._counts and now_s - self._listed_s < _FRESH_S
        if not (is_fresh and self._all_named):
            self._counts, self._listed_s = counts, now_s
            self._listed = self._list_ends()
        return self._listed

    def _list_ends(self) -> defaultdict[str, set[_End]]:
        found: defaultdict[str, set[_End]] = defaultdict(set)
        self._all_named = True
        for topic in (*TOPICS, *VIEW_TOPICS):
            name = self._node.resolve_topic_name(topic.name)
            for says, infos in (
                (True, self._node.get_publishers_info_by_topic(name)),
                (False, self._node.get_subscriptions_info_by_topic(name)),
            ):
                for node_name, space in map(self._name_of, infos):
                    self._all_named &= node_name != ''
                    if space == self._node.get_namespace():
                        found[node_name].add(_End(says, topic.name))
        return found

    def _name_of(self, info: Any) -> tuple[str, str]:
        """Name and namespace of the node of an endpoint; empty if they were never known."""
        end = bytes(info.endpoint_gid)
        if info.node_name != _UNKNOWN:
            self._names[end] = info.node_name, info.node_namespace
            self._names.move_to_end(end)
            while len(self._names) > _MOST_NAMES:
                self._names.popitem(last=False)
        return self._names.get(end, ('', ''))


class _End(NamedTuple):
    """An endpoint of a topic: a publisher or a subscription, by the name of the topic."""

    says: bool
    topic: str


_NOT_ALWAYS_SAID = {_End(True, PROPOSAL.name)}
"""A person and a page are optional."""


def _wanted(name: str) -> set[_End]:
    """The endpoints of a node of this package; none for other nodes."""
    topics = GRAPH.get(name)
    if topics is None:
        return set()
    said: list[Topic | ViewTopic] = [*topics.says, *topics.views]
    says = {_End(True, topic.name) for topic in said}
    return says | {_End(False, topic.name) for topic in topics.listens}
