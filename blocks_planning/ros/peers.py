"""Which other nodes are there."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from rclpy.node import Node

from blocks_planning.ros.graph import GRAPH, NodeTopics


def missing_peers(node: Node, names: Iterable[str]) -> list[str]:
    """The nodes, of this one's namespace, that are not there with all of their topics.

    Of a node that is not of this package only the name is looked for.
    """
    present = {
        name for name, space in node.get_node_names_and_namespaces() if space == _space(node)
    }
    return [name for name in names if name not in present or not _is_complete(node, name)]


class Peers(NamedTuple):
    """The other ends of a node's topics.

    Attributes:
        present: names of the nodes that are there, in order.
        missing: names of those that this package has for what nobody says.
    """

    present: list[str]
    missing: list[str]


def peers_of(node: Node, topics: NodeTopics) -> Peers:
    """Who is at the other ends of a node's topics."""
    present: set[str] = set()
    unsaid = set()
    for topic in topics.listens:
        name = node.resolve_topic_name(topic.name)
        sources = _ends(node.get_publishers_info_by_topic(name))
        present |= {end for end, _ in sources}
        if not sources:
            unsaid.add(topic.name)
    for topic in topics.says:
        name = node.resolve_topic_name(topic.name)
        present |= {end for end, _ in _ends(node.get_subscriptions_info_by_topic(name))}
    missing = [
        other.name
        for other in GRAPH.values()
        if other.name not in present and any(topic.name in unsaid for topic in other.says)
    ]
    return Peers(sorted(present - {topics.name}), missing)


class Attendance:
    """How long whoever is not there has been missing."""

    def __init__(self) -> None:
        """Nobody is missing."""
        self._since: dict[str, float] = {}

    def note(self, missing: Iterable[str], now_s: float) -> list[str]:
        """Take note of who is missing at a moment [s]; return who has just gone."""
        since = {name: self._since.get(name, now_s) for name in missing}
        gone = [name for name in since if name not in self._since]
        self._since = since
        return gone

    @property
    def missing(self) -> list[str]:
        """Who is missing."""
        return list(self._since)

    def overdue(self, now_s: float, bound_s: float, begin_s: float) -> str:
        """Who has been missing for ``bound_s`` or longer since ``begin_s``, as a sentence; or ''."""
        waited = {name: now_s - max(since, begin_s) for name, since in self._since.items()}
        late = [f'{name} for {wait:.1f} s' for name, wait in waited.items() if wait >= bound_s]
        return f'missing: {", ".join(late)}' if late else ''


def _space(node: Node) -> str:
    return str(node.get_namespace())


def _is_complete(node: Node, name: str) -> bool:
    topics = GRAPH.get(name)
    if topics is None:
        return True
    me = (name, _space(node))
    return all(
        me in _ends(node.get_subscriptions_info_by_topic(node.resolve_topic_name(topic.name)))
        for topic in topics.listens
    ) and all(
        me in _ends(node.get_publishers_info_by_topic(node.resolve_topic_name(topic.name)))
        for topic in topics.says
    )


def _ends(infos: Iterable[Any]) -> set[tuple[str, str]]:
    return {(info.node_name, info.node_namespace) for info in infos}
