"""What is done to whom, and when: drawn from a seed."""

from __future__ import annotations

import random
from collections.abc import Iterator
from typing import NamedTuple

NODES = (
    'world',
    'subgoal_selector',
    'action_searcher',
    'trial_orchestrator',
    'bag_recorder',
)
PHASES = ('idle', 'searching', 'placing', 'journal', 'record', 'starting', 'any')
"""When a node is killed.

idle: when a trial has just ended; searching: when a search was asked for; placing: between an
action and the state it leads to; journal: when the journal has just grown, or begun; record: when
a record has just been written, before it is on disk; starting: while the node is being started;
any: at a moment that nothing has led to.
"""
BRINGUP = 'bring-up'


class Fault(NamedTuple):
    """Something that happens to a node.

    Attributes:
        kind: kill; late: killed, and not started again for a while; pause: stopped and continued;
            copy: a second one is started.
        node: whose process.
        phase: in which it happens.
        delay_s: after what the phase begins with [s]; for starting, in start times of a node.
        hold_s: how long a pause, or a late start, takes [s].
        at_once: whether it comes before the node has recovered from the last fault.
    """

    kind: str
    node: str
    phase: str
    delay_s: float
    hold_s: float = 0.0
    at_once: bool = False

    @property
    def kills(self) -> bool:
        """Whether a process is killed."""
        return self.kind in ('kill', 'late')


def make_plan(seed: int, kills: int) -> Iterator[Fault]:
    """Faults with so many kills among them; every node in every phase in turn."""
    chance = random.Random(seed)
    pairs: list[tuple[str, str]] = []
    done = 0
    while done < kills:
        if not pairs:
            pairs = [(node, phase) for node in NODES for phase in PHASES]
            chance.shuffle(pairs)
            pairs.insert(chance.randrange(5, len(pairs)), (BRINGUP, 'any'))
        node, phase = pairs.pop(0)
        kind = 'kill'
        if node != BRINGUP and phase != 'starting':
            kind = chance.choices(('kill', 'late', 'pause', 'copy'), (17, 1, 1.2, 0.5))[0]
        fault = Fault(
            kind,
            node,
            phase,
            delay_s=chance.choice((0.0, 0.002, chance.uniform(0.0, 0.02))),
            hold_s=chance.choice((0.3, 0.3, 2.0, 7.0))
            if kind == 'pause'
            else chance.uniform(0.5, 3.0),
            at_once=chance.random() < 0.4,
        )
        if phase == 'any':
            fault = fault._replace(delay_s=chance.uniform(0.0, 0.5))
        if phase == 'starting':
            fault = fault._replace(delay_s=chance.uniform(0.0, 1.2))
        if kind not in ('kill', 'late'):
            pairs.append((node, phase))  # it has still to be killed then
        yield fault
        done += fault.kills
