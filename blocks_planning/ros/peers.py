"""Which other nodes are there."""

from __future__ import annotations

from collections.abc import Iterable

from rclpy.node import Node

from blocks_planning.ros.graph import GRAPH
from blocks_planning.ros.topics import Topic, ViewTopic


def missing_peers(node: Node, names: Iterable[str]) -> list[str]:
    """The nodes, of this one's namespace, that are not there with all of their topics.

    Of a node that is not of this package only the name is looked for.
    """
    present = {
        name for name, space in node.get_node_names_and_namespaces() if space == _space(node)
    }
    return [name for name in names if name not in present or not _is_complete(node, name)]


def _space(node: Node) -> str:
    return str(node.get_namespace())


def _is_complete(node: Node, name: str) -> bool:
    topics = GRAPH.get(name)
    if topics is None:
        return True
    me = (name, _space(node))
    said: list[Topic | ViewTopic] = [*topics.says, *topics.views]
    return all(
        me in _ends(node.get_subscriptions_info_by_topic(node.resolve_topic_name(topic.name)))
        for topic in topics.listens
    ) and all(
        me in _ends(node.get_publishers_info_by_topic(node.resolve_topic_name(topic.name)))
        for topic in said
    )


def _ends(infos: Iterable[object]) -> set[tuple[str, str]]:
    return {(info.node_name, info.node_namespace) for info in infos}  # type: ignore[attr-defined]
