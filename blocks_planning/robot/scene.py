"""The scene as an MJCF model: table, feeder, gantry, cameras, blocks.

The gantry is not the model of a product. It needs no meshes, so nothing is downloaded and no
further licence applies; the joint positions are the tool position, so no inverse kinematics is
needed; and the fingers stay in front of and behind the board, where the tower never obstructs them.

The integrator, the friction cones and ``impratio`` make a grip by friction stable: with pyramidal
cones or an impratio of 1 a block creeps out of the fingers.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from xml.etree import ElementTree as Xml

from blocks_planning.board.blocks import Block
from blocks_planning.robot import colours
from blocks_planning.robot.settings import RobotSettings
from blocks_planning.robot.sizes import Sizes

TIMESTEP = 0.002
"""[s]"""
AXES = ('gantry_x', 'gantry_z')
FINGERS = ('finger_front', 'finger_back')
JOINTS = (*AXES, *FINGERS)
FRONT_CAMERA, FILM_CAMERA, FILM_LIGHT = 'front', 'film', 'film_light'
PIXELS_PER_CELL = 16
"""Resolution of the front camera."""
STIFFNESS = 40000.0
"""Stiffness of an axis [N/m]: a block of 0.2 kg lowers it by 0.05 mm."""
DAMPING = 900.0
"""Damping of an axis [N s/m]: slightly above critical for the moving mass."""

_BLOCK_CONTACT = {'contype': '1', 'conaffinity': '3', 'solref': '0.005 1'}
_ARM_CONTACT = {'contype': '2', 'conaffinity': '1'}
_NO_CONTACT = {'contype': '0', 'conaffinity': '0'}
_STEEL, _PAD, _TABLE = '0.35 0.37 0.4 1', '0.15 0.15 0.16 1', '0.86 0.86 0.84 1'


@dataclass(frozen=True)
class Pose:
    """Position [m] and orientation (quaternion w, x, y, z) in the frame of the board."""

    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Body:
    """A block in the scene.

    Attributes:
        number: counts the blocks that the feeder has presented, from 0.
        block: its size [cells].
        pose: its pose when the model is created.
        fixed: whether it is glued.
    """

    number: int
    block: Block
    pose: Pose
    fixed: bool = False

    @property
    def name(self) -> str:
        """Its name in the model."""
        return f'block_{self.number}'


def model_text(sizes: Sizes, settings: RobotSettings, bodies: Iterable[Body]) -> str:
    """The model as MJCF text."""
    root = Xml.Element('mujoco', model='blocks_planning')
    _add(root, 'compiler', angle='radian', autolimits='true')
    _add(
        root,
        'option',
        timestep=str(TIMESTEP),
        integrator='implicitfast',
        cone='elliptic',
        impratio='10',
    )
    _add_appearance(root, sizes)
    world = _add(root, 'worldbody')
    _add_surroundings(world, sizes, settings)
    _add_arm(world, sizes)
    for body in bodies:
        _add_block(world, sizes, settings, body)
    _add_actuators(root, sizes, settings)
    return Xml.tostring(root, encoding='unicode')


def _add(parent: Xml.Element, tag: str, **attributes: str) -> Xml.Element:
    return Xml.SubElement(parent, tag, attributes)


def _numbers(*values: float) -> str:
    return ' '.join(map(repr, values))


def _add_appearance(root: Xml.Element, sizes: Sizes) -> None:
    visual = _add(root, 'visual')
    side = str(PIXELS_PER_CELL * max(sizes.board.width, sizes.board.height, 40))
    _add(visual, 'global', offwidth=side, offheight=side)
    # No anti-aliasing: a pixel has the colour of one block, not a mixture.
    _add(visual, 'quality', offsamples='0', shadowsize='1024')
    # Ambient light only, so that the colour of a block does not depend on its place.
    _add(visual, 'headlight', ambient='1 1 1', diffuse='0 0 0', specular='0 0 0', active='1')
    asset = _add(root, 'asset')
    _add(
        asset,
        'texture',
        type='skybox',
        builtin='flat',
        rgb1='0.95 0.96 0.97',
        rgb2='0.95 0.96 0.97',
        width='32',
        height='32',
    )
    _add(asset, 'material', name='matt', specular='0', shininess='0', reflectance='0')


def _add_surroundings(world: Xml.Element, sizes: Sizes, settings: RobotSettings) -> None:
    board, cell = sizes.board, sizes.cell
    width, height = board.width * cell, board.height * cell
    _add(
        world,
        'geom',
        name='table',
        type='plane',
        size=_numbers(400 * cell, 400 * cell, 1.0),
        material='matt',
        rgba=_TABLE,
        friction=_numbers(settings.friction, 0.005, 0.0001),
        **_BLOCK_CONTACT,
    )
    _add_site(world, 'board', (width / 2, sizes.middle, 0.0005), (width / 2, cell / 2, 0.0005))
    first = sizes.feeder(Block(1, 1))
    _add_site(world, 'feeder', (first, sizes.middle, 0.0005), (cell, cell, 0.0005))
    _add(
        world,
        'camera',
        name=FRONT_CAMERA,
        projection='orthographic',
        pos=_numbers(width / 2, -10 * cell, height / 2),
        xyaxes='1 0 0 0 0 1',
        fovy=repr(height),
    )
    # A light for films only; it is off, so that the front camera sees plain colours.
    _add(
        world,
        'light',
        name=FILM_LIGHT,
        active='false',
        directional='true',
        pos=_numbers(width / 2 - 6 * cell, -15 * cell, 30 * cell),
        dir='0.3 0.55 -1',
        diffuse='0.5 0.5 0.5',
        specular='0 0 0',
    )
    span = max(board.width + 9, 1.5 * board.height + 6) * cell
    _add(
        world,
        'camera',
        name=FILM_CAMERA,
        pos=_numbers(width / 2 + 1.0 * cell, -1.05 * span, height + 3 * cell),
        xyaxes='1 0.2 0 -0.04 0.2 1',
        fovy='42',
    )


def _add_site(
    world: Xml.Element, name: str, centre: tuple[float, ...], half: tuple[float, ...]
) -> None:
    _add(
        world,
        'geom',
        name=name,
        type='box',
        pos=_numbers(*centre),
        size=_numbers(*half),
        material='matt',
        rgba='0.7 0.72 0.74 1',
        **_NO_CONTACT,
    )


def _add_box(
    body: Xml.Element,
    name: str,
    centre: tuple[float, float, float],
    half: tuple[float, float, float],
    mass: float,
    **more: str,
) -> None:
    _add(
        body,
        'geom',
        name=name,
        type='box',
        pos=_numbers(*centre),
        size=_numbers(*half),
        mass=repr(mass),
        material='matt',
        **{'rgba': _STEEL, **_ARM_CONTACT, **more},
    )


def _add_arm(world: Xml.Element, sizes: Sizes) -> None:
    cell, rail = sizes.cell, sizes.rail
    low, high = sizes.reach
    beam = ((low + high) / 2, sizes.middle + cell, rail)
    half = ((high - low) / 2 + cell, 0.25 * cell, 0.25 * cell)
    _add_box(world, 'beam', beam, half, 1.0, **_NO_CONTACT)
    carriage = _moving(world, 'carriage', (0.0, sizes.middle, 0.0), AXES[0], '1 0 0', (low, high))
    _add_box(
        carriage, 'trolley', (0, 0, rail), (0.8 * cell, 0.7 * cell, 0.6 * cell), 1.5, **_NO_CONTACT
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
    body = _add(parent, 'body', name=name, pos=_numbers(*place), gravcomp='1')
    _add(body, 'joint', name=joint, type='slide', axis=axis, range=_numbers(*bounds))
    return body


def _add_block(world: Xml.Element, sizes: Sizes, settings: RobotSettings, body: Body) -> None:
    element = _add(
        world,
        'body',
        name=body.name,
        pos=_numbers(*body.pose.position),
        quat=_numbers(*body.pose.orientation),
    )
    if not body.fixed:
        _add(element, 'freejoint', name=body.name)
    _add(
        element,
        'geom',
        name=body.name,
        type='box',
        size=_numbers(*sizes.half(body.block)),
        density=repr(settings.density),
        material='matt',
        rgba=_numbers(*(level / 255 for level in colours.colour_of(body.number)), 1),
        friction=_numbers(settings.friction, 0.005, 0.0001),
        **_BLOCK_CONTACT,
    )


def _add_actuators(root: Xml.Element, sizes: Sizes, settings: RobotSettings) -> None:
    actuators = _add(root, 'actuator')
    for name in AXES:
        _add_servo(actuators, name, STIFFNESS, DAMPING)
    stiffness = settings.grip_force_n / sizes.overclosing
    for name in FINGERS:
        # Critical damping for a finger of 0.1 kg.
        _add_servo(actuators, name, stiffness, 2 * (0.1 * stiffness) ** 0.5)


def _add_servo(actuators: Xml.Element, joint: str, stiffness: float, damping: float) -> None:
    _add(
        actuators,
        'position',
        name=joint,
        joint=joint,
        kp=repr(stiffness),
        kv=repr(damping),
        inheritrange='1',
    )
