"""The scene as an MJCF model: table, feeder, gantry, cameras, blocks.

The integrator, the friction cones and ``impratio`` make a grip by friction stable: with pyramidal
cones or an impratio of 1 a block creeps out of the fingers.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from xml.etree import ElementTree as Xml

from blocks_planning.board.blocks import Block
from blocks_planning.robot import colours
from blocks_planning.robot.gantry import add_actuators, add_arm
from blocks_planning.robot.mjcf import NO_CONTACT, add, numbers
from blocks_planning.robot.settings import RobotSettings
from blocks_planning.robot.sizes import Sizes

TIMESTEP = 0.002
"""[s]"""
FRONT_CAMERA, FILM_CAMERA, FILM_LIGHT = 'front', 'film', 'film_light'
PIXELS_PER_CELL = 16
"""Resolution of the front camera."""

_TABLE = '0.86 0.86 0.84 1'
_BLOCK_CONTACT = {'contype': '1', 'conaffinity': '3', 'solref': '0.005 1'}


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
    add(root, 'compiler', angle='radian', autolimits='true')
    add(
        root,
        'option',
        timestep=str(TIMESTEP),
        integrator='implicitfast',
        cone='elliptic',
        impratio='10',
    )
    _add_appearance(root, sizes)
    world = add(root, 'worldbody')
    _add_surroundings(world, sizes, settings)
    add_arm(world, sizes)
    for body in bodies:
        _add_block(world, sizes, settings, body)
    add_actuators(root, sizes, settings)
    return Xml.tostring(root, encoding='unicode')


def _add_appearance(root: Xml.Element, sizes: Sizes) -> None:
    visual = add(root, 'visual')
    side = str(PIXELS_PER_CELL * max(sizes.board.width, sizes.board.height, 40))
    add(visual, 'global', offwidth=side, offheight=side)
    # No anti-aliasing: a pixel has the colour of one block, not a mixture.
    add(visual, 'quality', offsamples='0', shadowsize='1024')
    # Ambient light only, so that the colour of a block does not depend on its place.
    add(visual, 'headlight', ambient='1 1 1', diffuse='0 0 0', specular='0 0 0', active='1')
    asset = add(root, 'asset')
    add(
        asset,
        'texture',
        type='skybox',
        builtin='flat',
        rgb1='0.95 0.96 0.97',
        rgb2='0.95 0.96 0.97',
        width='32',
        height='32',
    )
    add(asset, 'material', name='matt', specular='0', shininess='0', reflectance='0')


def _add_surroundings(world: Xml.Element, sizes: Sizes, settings: RobotSettings) -> None:
    board, cell = sizes.board, sizes.cell
    width, height = board.width * cell, board.height * cell
    add(
        world,
        'geom',
        name='table',
        type='plane',
        size=numbers(400 * cell, 400 * cell, 1.0),
        material='matt',
        rgba=_TABLE,
        friction=numbers(settings.friction, 0.005, 0.0001),
        **_BLOCK_CONTACT,
    )
    _add_site(world, 'board', (width / 2, sizes.middle, 0.0005), (width / 2, cell / 2, 0.0005))
    first = sizes.feeder(Block(1, 1))
    _add_site(world, 'feeder', (first, sizes.middle, 0.0005), (cell, cell, 0.0005))
    add(
        world,
        'camera',
        name=FRONT_CAMERA,
        projection='orthographic',
        pos=numbers(width / 2, -10 * cell, height / 2),
        xyaxes='1 0 0 0 0 1',
        fovy=repr(height),
    )
    # A light for films only; it is off, so that the front camera sees plain colours.
    add(
        world,
        'light',
        name=FILM_LIGHT,
        active='false',
        directional='true',
        pos=numbers(width / 2 - 6 * cell, -15 * cell, 30 * cell),
        dir='0.3 0.55 -1',
        diffuse='0.5 0.5 0.5',
        specular='0 0 0',
    )
    span = max(board.width + 9, 1.5 * board.height + 6) * cell
    add(
        world,
        'camera',
        name=FILM_CAMERA,
        pos=numbers(width / 2 + 1.0 * cell, -1.05 * span, height + 3 * cell),
        xyaxes='1 0.2 0 -0.04 0.2 1',
        fovy='42',
    )


def _add_site(
    world: Xml.Element, name: str, centre: tuple[float, ...], half: tuple[float, ...]
) -> None:
    add(
        world,
        'geom',
        name=name,
        type='box',
        pos=numbers(*centre),
        size=numbers(*half),
        material='matt',
        rgba='0.7 0.72 0.74 1',
        **NO_CONTACT,
    )


def _add_block(world: Xml.Element, sizes: Sizes, settings: RobotSettings, body: Body) -> None:
    element = add(
        world,
        'body',
        name=body.name,
        pos=numbers(*body.pose.position),
        quat=numbers(*body.pose.orientation),
    )
    if not body.fixed:
        add(element, 'freejoint', name=body.name)
    add(
        element,
        'geom',
        name=body.name,
        type='box',
        size=numbers(*sizes.half(body.block)),
        density=repr(settings.density),
        material='matt',
        rgba=numbers(*(level / 255 for level in colours.colour_of(body.number)), 1),
        friction=numbers(settings.friction, 0.005, 0.0001),
        **_BLOCK_CONTACT,
    )
