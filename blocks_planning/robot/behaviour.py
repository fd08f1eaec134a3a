"""The behaviour of the arm: one act carries out one order, phase by phase."""

from __future__ import annotations

from collections.abc import Callable

from blocks_planning.board.blocks import Block, Placement
from blocks_planning.robot import moving
from blocks_planning.robot.arm import closed
from blocks_planning.robot.feeder import Feeder
from blocks_planning.robot.lowering import Descent, descend
from blocks_planning.robot.memory import Memory
from blocks_planning.robot.phases import ACT, BOUNDS_S, LATE, Phase, Progress, Reason, Report
from blocks_planning.robot.simulation import STILL, Simulation


class Behaviour:
    """Moves the arm, one time step after the other.

    Attributes:
        memory: the state of the act.
    """

    def __init__(self, simulation: Simulation, feeder: Feeder, slack: float) -> None:
        """An arm at rest beside the board.

        Args:
            simulation: the simulation.
            feeder: presents the ordered block.
            slack: tolerance of the perceived height of the tower [m].
        """
        self.simulation = simulation
        self.sizes = simulation.sizes
        self._feeder = feeder
        self.memory = Memory()
        self._slack = 0.3 * self.sizes.cell + slack
        arm = self.memory.arm
        arm.x.position, arm.z.position = self.sizes.feeder(Block(1, 1)), 4 * self.sizes.cell
        simulation.put_arm(arm.commands)
        self._phases: dict[Phase, Callable[[], Phase | None]] = {
            Phase.APPROACH: self._approach,
            Phase.GRASP: self._grasp,
            Phase.LIFT: self._lift,
            Phase.CARRY: self._carry,
            Phase.LOWER: self._lower,
            Phase.RELEASE: self._release,
            Phase.RETREAT: self._retreat,
            Phase.SETTLE: self._settle,
            Phase.BRING_BACK: self._bring_back,
        }

    # --- orders -----------------------------------------------------------------------------

    def begin(self, placement: Placement, row: int | None, top: float) -> None:
        """Begin an act, for which the feeder presents the block.

        Before that, a block that is still held from an earlier act is brought back, and an arm that
        is so low that it could touch the block moves up.

        Args:
            placement: the order.
            row: row on which the block is expected to come to rest; None: nowhere on the board.
            top: highest point of the tower [m].
        """
        old, now, sizes = self.memory, self.simulation.time, self.sizes
        height = placement.block.height * sizes.cell
        is_prepared = not self.is_holding and old.arm.z.position > height + sizes.pad[2]
        number = self._feeder.present(placement.block) if is_prepared else old.number
        self.memory = memory = Memory(placement, number, began=now, entered=now, arm=old.arm)
        hanging = max(height, self._held_height) - sizes.below_top
        memory.travel = max(top, height) + sizes.clearance + max(hanging, sizes.pad[2])
        memory.landing = (row or 0) * sizes.cell + height - sizes.below_top
        memory.phase = Phase.APPROACH if is_prepared else Phase.BRING_BACK
        if row is None:
            block, column = placement
            memory.failed, memory.reason = Phase.APPROACH, Reason.OUT_OF_REACH
            memory.text = f'block {block} in column {column} would not end on the board'
            memory.phase = Phase.RETREAT if is_prepared else Phase.BRING_BACK

    def cancel(self) -> None:
        """Stop the arm; it keeps holding its block."""
        self.memory.stopping = self.is_busy

    @property
    def is_busy(self) -> bool:
        """Whether an act is in progress."""
        return self.memory.phase is not Phase.IDLE

    @property
    def is_holding(self) -> bool:
        """Whether the closed fingers hold a block that they can carry: it is not glued yet."""
        is_closed = moving.is_holding(self.simulation, self.memory.arm)
        return is_closed and not self.simulation.body(self.memory.number).fixed

    def step(self) -> Report | None:
        """Simulate one time step; return the report of the act if it has ended."""
        memory, report = self.memory, None
        if memory.stopping:
            report = self._stop()
        elif self.is_busy:
            report = self._work()
        self.simulation.command(memory.arm.commands)
        self.simulation.step()
        return report

    @property
    def progress(self) -> Progress:
        """The progress of the act."""
        phase = self.memory.phase
        done = ACT.index(phase) / len(ACT) if phase in ACT else 0.0
        return Progress(phase, done, self.simulation.time)

    # --- from phase to phase ----------------------------------------------------------------

    def _work(self) -> Report | None:
        memory = self.memory
        phase = memory.phase
        following = self._phases[phase]()
        if memory.phase is not phase:
            return None  # it has failed
        if following is not None:
            self._enter(following)
        elif moving.is_blocked(self.simulation, memory.arm):
            self._fail(Reason.COLLISION, 'the arm was blocked')
        elif self.simulation.time - memory.entered > BOUNDS_S[phase]:
            if phase is Phase.SETTLE:
                self._enter(Phase.IDLE)
            else:
                self._fail(LATE[phase], f'it took longer than {BOUNDS_S[phase]:g} s')
        return None if self.is_busy else self._report()

    def _enter(self, phase: Phase) -> None:
        self.memory.phase = phase
        self.memory.entered, self.memory.at_rest = self.simulation.time, 0.0

    def _fail(self, reason: Reason, text: str) -> None:
        """Store the first failure; then bring back the held block, or open and move up."""
        memory, phase = self.memory, self.memory.phase
        if memory.reason is None:
            memory.failed, memory.reason, memory.text = phase, reason, f'{phase.value}: {text}'
        moving.halt(self.simulation, memory.arm)
        if phase is Phase.RETREAT:
            self._enter(Phase.SETTLE)
        elif phase is not Phase.BRING_BACK and self.is_holding:
            self._enter(Phase.BRING_BACK)
        else:
            self._enter(Phase.RETREAT)

    def _stop(self) -> Report | None:
        memory = self.memory
        memory.arm.stop()
        if not memory.arm.is_at_rest:
            return None
        if memory.reason is None:
            memory.failed, memory.reason = memory.phase, Reason.CANCELLED
            memory.text = f'{memory.phase.value}: cancelled'
        memory.stopping, memory.phase, memory.settled = False, Phase.IDLE, False
        return self._report()

    def _report(self) -> Report:
        memory = self.memory
        assert memory.placement is not None
        return Report(
            memory.placement,
            memory.failed or Phase.SETTLE,
            memory.reason,
            memory.text,
            self.simulation.time - memory.began,
            memory.settled,
        )

    # --- the phases: each returns the next one, or None to continue ------------------------------

    def _approach(self) -> Phase | None:
        memory = self.memory
        memory.arm.grip_towards(0.0)
        if memory.arm.grip > 0 or not self._is_above_feeder():
            return None
        return Phase.GRASP if self._go(z=self._grasp_z) else None

    def _grasp(self) -> Phase | None:
        arm, goal = self.memory.arm, closed(self.sizes)
        arm.grip_towards(goal)
        if arm.grip != goal or not self.memory.rests(
            abs(self.simulation.speeds[2:]).max() < STILL
        ):
            return None
        if not self.is_holding:
            self._fail(Reason.NOTHING_GRASPED, 'the fingers hold nothing')
            return None
        return Phase.LIFT

    def _lift(self) -> Phase | None:
        if self._has_dropped() or not self.memory.rests(self._go(z=self.memory.travel)):
            return None
        return Phase.CARRY

    def _carry(self) -> Phase | None:
        if self._has_dropped() or not self.memory.rests(self._go(x=self._goal_x)):
            return None
        self.memory.load = self.simulation.lift
        return Phase.LOWER

    def _lower(self) -> Phase | None:
        memory, simulation = self.memory, self.simulation
        if self._has_dropped():
            return None
        match descend(simulation, memory, self._goal_x, self._slack):
            case Descent.STANDS:
                if simulation.settings.glue:
                    simulation.glue([memory.number])
                return Phase.RELEASE
            case Descent.TOO_HIGH:
                excess = (float(simulation.joints[1]) - memory.landing) / self.sizes.cell
                self._fail(Reason.COLLISION, f'contact {excess:.1f} cells too high')
            case Descent.NOTHING_BELOW:
                self._fail(Reason.OUT_OF_REACH, 'there was no support')
        return None

    def _release(self) -> Phase | None:
        self.memory.arm.grip_towards(0.0)
        is_open = self.simulation.joints[2:].max() < 0.1 * self.sizes.open_gap
        return Phase.RETREAT if self.memory.rests(is_open) else None

    def _retreat(self) -> Phase | None:
        self.memory.arm.grip_towards(0.0)
        return Phase.SETTLE if self._go(z=self.memory.travel) else None

    def _settle(self) -> Phase | None:
        simulation, memory = self.simulation, self.memory
        loose = [body.number for body in simulation.free]
        memory.settled = self.memory.rests(simulation.fastest(loose) < STILL)
        if not memory.settled:
            return None
        if simulation.settings.glue:
            simulation.glue(number for number in loose if not simulation.is_at_feeder(number))
        return Phase.IDLE

    def _bring_back(self) -> Phase | None:
        """Carry a held block back; then continue with the order, or retreat if it has failed."""
        memory = self.memory
        if self.is_holding:
            # Drop it from a small height, so that it is not pushed into the table.
            low = self._held_height - self.sizes.below_top + 0.1 * self.sizes.cell
            if not self._is_above_feeder() or not self._go(z=low):
                return None
        memory.arm.grip_towards(0.0)
        if memory.arm.grip > 0:
            return None
        if memory.reason is not None:
            return Phase.RETREAT
        if not self._go(z=memory.travel):  # the next block may be higher
            return None
        memory.number = self._feeder.present(self._block)
        return Phase.APPROACH

    # --- common parts of the phases ----------------------------------------------------------

    @property
    def _block(self) -> Block:
        assert self.memory.placement is not None
        return self.memory.placement.block

    @property
    def _held_height(self) -> float:
        """Height of the block between the fingers [m]; 0 if there is none."""
        if not self.is_holding:
            return 0.0
        return self.simulation.body(self.memory.number).block.height * self.sizes.cell

    @property
    def _feeder_x(self) -> float:
        return self.sizes.feeder(self._block)

    @property
    def _grasp_z(self) -> float:
        return self._block.height * self.sizes.cell - self.sizes.below_top

    @property
    def _goal_x(self) -> float:
        assert self.memory.placement is not None
        column = self.memory.placement.column
        return self.sizes.centre(column, self._block.width)

    def _go(self, x: float | None = None, z: float | None = None, **pace: float) -> bool:
        """Move towards a target; return whether the arm is there."""
        return moving.go(self.simulation, self.memory.arm, x, z, **pace)

    def _is_above_feeder(self) -> bool:
        """Move up, then over to the feeder; return whether the arm is above it, or lower."""
        arm, x = self.memory.arm, self._feeder_x
        return moving.go_over(self.simulation, arm, x, self.memory.travel)

    def _has_dropped(self) -> bool:
        """Whether the block was lost; then the act has failed."""
        if self.is_holding:
            return False
        self._fail(Reason.DROPPED, 'the block slipped out of the fingers')
        return True
