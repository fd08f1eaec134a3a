"""All that an act depends on besides the simulation: what is saved to go on with it later."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

from blocks_planning.board.blocks import Block, Placement
from blocks_planning.robot.arm import Arm, Axis
from blocks_planning.robot.phases import Phase, Reason
from blocks_planning.robot.scene import TIMESTEP

REST_S = 0.06
"""How long something must be at rest to count [s]."""


@dataclass
class Memory:
    """Where an act is.

    Attributes:
        placement: what was ordered; None before the first order.
        number: of the block that was presented.
        phase: what the arm does.
        began: when the act began [s].
        entered: when the phase began [s].
        at_rest: for how long what the phase waits for has been at rest [s].
        travel: z of the tool above everything that stands [m].
        landing: z of the tool where the block is expected to touch [m].
        load: what the z axis carried before the block was lowered [N].
        attempt: how many times the block met an edge on its way down.
        raised: z to which the tool goes before the next attempt [m]; None: it goes down.
        failed: the phase that failed.
        reason: why.
        text: the same in words.
        stopping: cancelled, and still slowing down.
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
        """Note for one time step whether something is at rest; whether it is for long enough."""
        self.at_rest = self.at_rest + TIMESTEP if is_at_rest else 0.0
        return self.at_rest >= REST_S

    def to_json(self) -> dict[str, Any]:
        """As JSON's own types."""
        return asdict(self)

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> Memory:
        """The memory that :meth:`to_json` wrote; the text is trusted."""
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
