"""The state of an act apart from the simulation; saved to continue the act later."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

from blocks_planning.board.blocks import Block, Placement
from blocks_planning.robot.arm import Arm, Axis
from blocks_planning.robot.phases import Phase, Reason
from blocks_planning.robot.scene import TIMESTEP

REST_S = 0.06
"""Time without motion after which something counts as at rest [s]."""


@dataclass
class Memory:
    """The state of an act.

    Attributes:
        placement: the order; None before the first one.
        number: of the block that was presented.
        phase: the current phase.
        began: start of the act [s].
        entered: start of the phase [s].
        at_rest: time for which the awaited object has been at rest [s].
        travel: z of the tool above the whole tower [m].
        landing: z of the tool at the expected contact [m].
        load: load of the z axis before lowering [N].
        attempt: number of contacts with an edge during lowering.
        raised: z to which the tool moves before the next attempt [m]; None: it moves down.
        failed: the phase that failed.
        reason: reason of the failure.
        text: the reason as a sentence.
        stopping: whether the act was cancelled and the arm is still slowing down.
        settled: whether everything had come to rest at the end of the last act.
        arm: the set points.
    """

    placement: Placement | None = None
    number: int = -1
    phase: Phase = Phase.IDLE
    began: float = 0.0
    entered: float = 0.0
    at_rest: float = 0.0
    travel: float = 0.0
    landing: float = 0.0
    load: float = 0.0
    attempt: int = 0
    raised: float | None = None
    failed: Phase | None = None
    reason: Reason | None = None
    text: str = ''
    stopping: bool = False
    settled: bool = True
    arm: Arm = field(default_factory=Arm)

    def rests(self, is_at_rest: object) -> bool:
        """Update for one time step; return whether the object has been at rest long enough."""
        self.at_rest = self.at_rest + TIMESTEP if is_at_rest else 0.0
        return self.at_rest >= REST_S

    def to_json(self) -> dict[str, Any]:
        """The memory as JSON types."""
        return asdict(self)

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> Memory:
        """The memory from the output of :meth:`to_json`; values are not checked."""
        placement, failed, reason = (values[key] for key in ('placement', 'failed', 'reason'))
        arm = values['arm']
        changed = {
            'placement': placement and Placement(Block(*placement[0]), placement[1]),
            'phase': Phase(values['phase']),
            'failed': failed and Phase(failed),
            'reason': reason and Reason(reason),
            'arm': Arm(Axis(**arm['x']), Axis(**arm['z']), arm['grip']),
        }
        return cls(**{**values, **changed})
