"""The health of the nodes, from their diagnostics."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

LEVELS = ('ok', 'warning', 'error', 'stale')
"""Names of the levels of diagnostic_msgs/DiagnosticStatus, by number."""
SILENT_S = 3.5
"""Nodes publish diagnostics every second; one is called silent after this time without any [s]."""
MOST_NODES = 64
MOST_VALUES = 32
MOST_CHARACTERS = 200


@dataclass(frozen=True)
class NodeHealth:
    """The latest status of a node.

    Attributes:
        level: of :data:`LEVELS`.
        values: of the status, by key.
        heard_s: time of receipt, on a monotonic clock [s].
    """

    name: str
    level: str
    message: str
    values: Mapping[str, str]
    heard_s: float


Health = Mapping[str, NodeHealth]
NOTHING: Health = MappingProxyType({})


def health_after(
    health: Health,
    name: str,
    level: int,
    message: str,
    values: Iterable[tuple[str, str]],
    heard_s: float,
) -> Health:
    """The health after a status of a node. Texts are cut; nodes beyond a limit are left out."""
    name = _cut(name)
    if name not in health and len(health) >= MOST_NODES:
        return health
    kept: dict[str, str] = {}
    for key, value in values:
        if len(kept) < MOST_VALUES:
            kept[_cut(key)] = _cut(value)
    word = LEVELS[level] if 0 <= level < len(LEVELS) else LEVELS[-1]
    return {**health, name: NodeHealth(name, word, _cut(message), kept, heard_s)}


def health_json(health: Health, now_s: float, hides_costs: bool) -> list[dict[str, Any]]:
    """The health as JSON for the page; only names and levels while costs are hidden."""
    return [
        {
            'name': node.name,
            'level': 'silent' if now_s - node.heard_s > SILENT_S else node.level,
            'message': '' if hides_costs else node.message,
            'values': [] if hides_costs else list(map(list, node.values.items())),
            'age': round(now_s - node.heard_s),
        }
        for _, node in sorted(health.items())
    ]


def _cut(text: str) -> str:
    return text if len(text) <= MOST_CHARACTERS else text[: MOST_CHARACTERS - 1] + '…'
