"""How the nodes are, as they say it themselves."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

LEVELS = ('ok', 'warning', 'error', 'stale')
"""By the numbers of diagnostic_msgs/DiagnosticStatus."""
SILENT_S = 3.5
"""Nodes say every second how they are; after so long without a word one is called silent [s]."""
MOST_NODES = 64
MOST_VALUES = 32
MOST_CHARACTERS = 200


@dataclass(frozen=True)
class NodeHealth:
    """What a node said last.

    Attributes:
        level: of :data:`LEVELS`.
        values: whatever it told, by key.
        heard_s: when, on a steady clock [s].
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
    """What is known after a node said how it is. Texts are cut, and nodes beyond a limit left out."""
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
    """As the page gets it; only names and levels where nothing of the search may be seen."""
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
