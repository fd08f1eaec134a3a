"""The state of a robot as bytes: a line of JSON, then the numbers of the simulation."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict
from typing import Any

import numpy as np

from blocks_planning.board.blocks import Block, Placed
from blocks_planning.errors import InvalidInput
from blocks_planning.robot.fitting import Misfit, Perceived, Remark
from blocks_planning.robot.memory import Memory
from blocks_planning.robot.scene import Body, Pose
from blocks_planning.robot.simulation import Simulation
from blocks_planning.settings import settings_of

FORMAT = 'blocks_planning/robot-state'
VERSION = 1
_DIGEST_BYTES = 16


def pack(simulation: Simulation, memory: Memory, seen: Perceived, perceptions: int) -> bytes:
    """The bytes that :func:`unpack` reads."""
    head = {
        'format': FORMAT,
        'version': VERSION,
        'scene': _scene_of(simulation),
        'next_number': simulation.next_number,
        'bodies': [asdict(body) for body in simulation.bodies],
        'memory': memory.to_json(),
        'blocks': seen.blocks,
        'warnings': [(one.kind.value, one.number, one.text) for one in seen.warnings],
        'perceptions': perceptions,
    }
    text = json.dumps(head, separators=(',', ':'), allow_nan=False).encode()
    content = text + b'\n' + simulation.state.astype('<f8').tobytes()
    return _digest(content) + content


def unpack(simulation: Simulation, data: bytes) -> tuple[Memory, Perceived, int]:
    """Restore a simulation; return the other saved data.

    Raises:
        InvalidInput: if the data are damaged, or of another version, board or settings.
    """
    content = data[_DIGEST_BYTES:]
    if data[:_DIGEST_BYTES] != _digest(content):
        raise InvalidInput(f'state of a robot ({len(data)} bytes): damaged, save it again')
    text, _, numbers = content.partition(b'\n')
    head = json.loads(text)
    found = head['format'], head['version']
    if found != (FORMAT, VERSION):
        raise InvalidInput(f'state of a robot: expected {FORMAT} version {VERSION}, got {found}')
    if head['scene'] != _scene_of(simulation):
        raise InvalidInput(
            f'state of a robot: it was saved with {head["scene"]}, '
            f'this robot has {_scene_of(simulation)}; use the same board and settings'
        )
    bodies = tuple(map(_body, head['bodies']))
    simulation.restore(bodies, head['next_number'], np.frombuffer(numbers, '<f8'))
    blocks = tuple((number, Placed(*placed)) for number, placed in head['blocks'])
    warnings = tuple(Remark(Misfit(kind), *rest) for kind, *rest in head['warnings'])
    return Memory.from_json(head['memory']), Perceived(blocks, warnings), head['perceptions']


def _digest(content: bytes) -> bytes:
    return hashlib.blake2b(content, digest_size=_DIGEST_BYTES).digest()


def _scene_of(simulation: Simulation) -> dict[str, Any]:
    """The properties that must be equal for a state to be usable."""
    board = simulation.sizes.board
    size = {'width': board.width, 'height': board.height}
    return {**size, **settings_of(simulation.settings)}


def _body(values: dict[str, Any]) -> Body:
    pose = values['pose']
    return Body(
        values['number'],
        Block(*values['block']),
        Pose(*map(tuple, (pose['position'], pose['orientation']))),
        values['fixed'],
    )
