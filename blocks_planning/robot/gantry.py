"""The gantry of the scene: rail, carriage, tool, fingers and their actuators.

It is not the model of a product. It needs no meshes, so nothing is downloaded and no further
licence applies; the joint positions are the tool position, so no inverse kinematics is needed; and
the fingers stay in front of and behind the board, where the tower never obstructs them.
"""

from __future__ import annotations

from xml.etree import ElementTree as Xml

from blocks_planning.robot.mjcf import NO_CONTACT, add, numbers
from blocks_planning.robot.settings import RobotSettings
from blocks_planning.robot.sizes import Sizes

AXES = ('gantry_x', 'gantry_z')
FINGERS = ('finger_front', 'finger_back')
JOINTS = (*AXES, *FINGERS)
STIFFNESS = 40000.0
"""Stiffness of an axis [N/m]: a block of 0.2 kg lowers it by 0.05 mm."""
DAMPING = 900.0
"""Damping of an axis [N s/m]: slightly above critical for the moving mass."""

_ARM_CONTACT = {'contype': '2', 'conaffinity': '1'}
_STEEL, _PAD = '0.35 0.37 0.4 1', '0.15 0.15 0.16 1'


def _add_box(
    body: Xml.Element,
    name: str,
    centre: tuple[float, float, float],
    half: tuple[float, float, float],
    mass: float,
    **more: str,
) -> None:
    add(
        body,
        'geom',
        name=name,
        type='box',
        pos=numbers(*centre),
        size=numbers(*half),
        mass=repr(mass),
        material='matt',
        **{'rgba': _STEEL, **_ARM_CONTACT, **more},
    )


def add_arm(world: Xml.Element, sizes: Sizes) -> None:
    """Append the rail and all that moves along it."""
    cell, rail = sizes.cell, sizes.rail
    low, high = sizes.reach
    beam = ((low + high) / 2, sizes.middle + cell, rail)
    half = ((high - low) / 2 + cell, 0.25 * cell, 0.25 * cell)
    _add_box(world, 'beam', beam, half, 1.0, **NO_CONTACT)
    carriage = _moving(world, 'carriage', (0.0, sizes.middle, 0.0), AXES[0], '1 0 0', (low, high))
    _add_box(
        carriage, 'trolley', (0, 0, rail), (0.8 * cell, 0.7 * cell, 0.6 * cell), 1.5, **NO_CONTACT
    )
    tool = _moving(carriage, 'tool', (0, 0, 0), AXES[1], '0 0 1', (0.0, rail))
    palm = sizes.palm_above
    reach = sizes.cell / 2 + sizes.open_gap + 2 * sizes.pad[1]
    _add_box(tool, 'palm', (0, 0, palm + 0.2 * cell), (0.2 * cell, reach, 0.2 * cell), 0.5)
    length = rail / 2
    _add_box(
        tool, 'mast', (0, 0, palm + 0.4 * cell + length), (0.2 * cell, 0.2 * cell, length), 0.5
    )
    for side, name in zip((-1, 1), FINGERS, strict=True):
        place = side * (cell / 2 + sizes.open_gap + sizes.pad[1])
        finger = _moving(
            tool,
            name,
            (0, place, 0),
            name,
            f'0 {-side} 0',
            (0.0, sizes.open_gap + cell / 2),
        )
        _add_box(
            finger, f'{name}_pad', (0, 0, 0), sizes.pad, 0.05, rgba=_PAD, friction='1 0.02 0.0001'
        )
        stem = palm / 2
        _add_box(
            finger,
            f'{name}_stem',
            (0, side * 0.02 * cell, stem),
            (0.2 * cell, 0.06 * cell, stem),
            0.05,
        )


def _moving(
    parent: Xml.Element,
    name: str,
    place: tuple[float, float, float],
    joint: str,
    axis: str,
    bounds: tuple[float, float],
) -> Xml.Element:
    body = add(parent, 'body', name=name, pos=numbers(*place), gravcomp='1')
    add(body, 'joint', name=joint, type='slide', axis=axis, range=numbers(*bounds))
    return body


def add_actuators(root: Xml.Element, sizes: Sizes, settings: RobotSettings) -> None:
    """Append a servo for each joint."""
    actuators = add(root, 'actuator')
    for name in AXES:
        _add_servo(actuators, name, STIFFNESS, DAMPING)
    stiffness = settings.grip_force_n / sizes.overclosing
    for name in FINGERS:
        # Critical damping for a finger of 0.1 kg.
        _add_servo(actuators, name, stiffness, 2 * (0.1 * stiffness) ** 0.5)


def _add_servo(actuators: Xml.Element, joint: str, stiffness: float, damping: float) -> None:
    add(
        actuators,
        'position',
        name=joint,
        joint=joint,
        kp=repr(stiffness),
        kv=repr(damping),
        inheritrange='1',
    )
