"""The feeder: presents the ordered block beside the board, and removes unplaced blocks."""

from __future__ import annotations

from blocks_planning.board.blocks import Block
from blocks_planning.robot import noise
from blocks_planning.robot.simulation import Simulation


class Feeder:
    """Presents blocks in a simulation; ``seed`` determines their exact positions."""

    def __init__(self, simulation: Simulation, seed: int) -> None:
        """Create the feeder beside the board."""
        self._simulation = simulation
        self._seed = seed

    def present(self, block: Block) -> int:
        """Clear the feeder and present a block; return its number."""
        simulation = self._simulation
        simulation.remove(
            body.number for body in simulation.free if simulation.is_at_feeder(body.number)
        )
        [off] = noise.normal(self._seed, 'grip', simulation.next_number)
        spread = simulation.settings.grip_noise_m
        return simulation.add(block, simulation.sizes.feeder(block) + spread * off)
