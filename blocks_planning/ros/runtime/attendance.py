"""How long required nodes have been missing."""

from __future__ import annotations

from collections.abc import Iterable


class Attendance:
    """The time since when each missing node has been missing."""

    def __init__(self) -> None:
        """Start with no node missing."""
        self._since: dict[str, float] = {}

    def note(self, missing: Iterable[str], now_s: float) -> list[str]:
        """Note which nodes are missing at a time [s]; return those that were present before."""
        since = {name: self._since.get(name, now_s) for name in missing}
        gone = [name for name in since if name not in self._since]
        self._since = since
        return gone

    @property
    def missing(self) -> list[str]:
        """The nodes that are missing."""
        return list(self._since)

    def overdue(self, now_s: float, bound_s: float, begin_s: float) -> str:
        """Nodes that have been missing for ``bound_s`` since ``begin_s``, as a sentence; or ''."""
        waited = {name: now_s - max(since, begin_s) for name, since in self._since.items()}
        late = [f'{name} for {wait:.1f} s' for name, wait in waited.items() if wait >= bound_s]
        return f'missing: {", ".join(late)}' if late else ''
