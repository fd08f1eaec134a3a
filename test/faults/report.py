"""What came of a plan."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from faults.plan import NODES, PHASES, Fault


@dataclass
class Report:
    """Counts of what was done, and everything that is not as it must be.

    Attributes:
        kills: by node and phase.
        others: faults that kill nothing, by kind.
        recoveries: how long it took after each kill that was waited for until a trial went on, or
            the bag grew, with the node there again [s].
        trials: number of records that must be there.
        lost: number of records that are not there.
        changed: number of records that are not what the undisturbed trial gives, or are there
            twice.
        restarts_s: how long the second start of each finished script took [s].
        complaints: everything else that went wrong, a sentence each.
    """

    kills: Counter[tuple[str, str]] = field(default_factory=Counter)
    others: Counter[str] = field(default_factory=Counter)
    recoveries: list[tuple[float, Fault]] = field(default_factory=list)
    trials: int = 0
    lost: int = 0
    changed: int = 0
    restarts_s: list[float] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)
    seconds: float = 0.0

    def add(self, fault: Fault) -> None:
        """A fault was done."""
        if fault.kills:
            self.kills[fault.node, fault.phase] += 1
        if fault.kind != 'kill':
            self.others[fault.kind] += 1

    def compare(self, found: list[str], expected: list[str]) -> None:
        """Compare the records of a script with those of the undisturbed trials."""
        self.trials += len(expected)
        self.lost += len(set(expected) - set(found))
        self.changed += len(set(found) - set(expected)) + len(found) - len(set(found))
        if len(found) == len(expected) and found != expected and set(found) == set(expected):
            self.complaints.append('the records are not in the order of the script')

    @property
    def slowest_s(self) -> float:
        """The slowest recovery [s]."""
        return max((seconds for seconds, _ in self.recoveries), default=0.0)

    @property
    def is_good(self) -> bool:
        """Whether nothing was lost, changed, or complained of."""
        return not (self.lost or self.changed or self.complaints)

    def to_json(self) -> dict[str, Any]:
        """Everything, for a file."""
        return {
            'kills': self.kills.total(),
            'kills_by_node_and_phase': {
                node: {phase: count for (n, phase), count in self.kills.items() if n == node}
                for node in dict.fromkeys(node for node, _ in self.kills)
            },
            'other_faults': dict(self.others),
            'recoveries': len(self.recoveries),
            'slowest_recovery_s': round(self.slowest_s, 3),
            'median_recovery_s': round(self._median_s, 3),
            'trials': self.trials,
            'lost': self.lost,
            'changed': self.changed,
            'slowest_second_start_s': round(max(self.restarts_s, default=0.0), 3),
            'complaints': self.complaints,
            'seconds': round(self.seconds, 1),
        }

    @property
    def _median_s(self) -> float:
        ordered = sorted(seconds for seconds, _ in self.recoveries)
        return ordered[len(ordered) // 2] if ordered else 0.0

    def lines(self) -> list[str]:
        """Everything, for people."""
        nodes = [*NODES, *sorted({node for node, _ in self.kills} - set(NODES))]
        rows = [['kills', *PHASES, 'all']]
        for node in nodes:
            counts = [self.kills[node, phase] for phase in PHASES]
            rows.append([node, *(str(count or '-') for count in counts), str(sum(counts))])
        lines = [f'{row[0]:<20}' + ''.join(f'{cell:>11}' for cell in row[1:]) for row in rows]
        data = self.to_json()
        slowest = max(self.recoveries, default=None, key=lambda pair: pair[0])
        lines += [
            '',
            (
                f'kills               {data["kills"]}, among {data["trials"]} trials '
                f'in {data["seconds"]} s'
            ),
            f'other faults        {data["other_faults"]}',
            f'recoveries          {data["recoveries"]}, median {data["median_recovery_s"]} s',
            f'slowest recovery    {data["slowest_recovery_s"]} s ({slowest and slowest[1]})',
            f'slowest second run  {data["slowest_second_start_s"]} s',
            f'lost                {self.lost}',
            f'changed             {self.changed}',
        ]
        return [*lines, *(f'WRONG: {complaint}' for complaint in self.complaints)]
