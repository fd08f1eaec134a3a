from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from blocks_planning.board.blocks import Block, Placed, Placement
from blocks_planning.board.geometry import Board
from blocks_planning.errors import ConfigurationError

pytest.importorskip(
    'mujoco', reason='the extra robot is not installed: pip install -r requirements/lock-robot.txt'
)

from blocks_planning.robot import colours
from blocks_planning.robot.camera import MOST_OFF, coverages
from blocks_planning.robot.film import Film
from blocks_planning.robot.rendering import why_blind
from blocks_planning.robot.robot import Robot
from blocks_planning.robot.scene import PIXELS_PER_CELL
from blocks_planning.robot.settings import CAMERA, RobotSettings

BOARD = Board(4, 4)


@pytest.fixture(scope='module')
def _eyes() -> None:
    reason = why_blind(Robot(Board(1, 1)).simulation)
    if reason:
        pytest.skip(reason)


def test_picture_is_cut_up_by_colour() -> None:
    side = PIXELS_PER_CELL
    picture = np.full((2 * side, 3 * side, 3), 230, np.uint8)
    picture[side:, : 2 * side] = colours.colour_of(4)
    picture[: side // 2, 2 * side :] = colours.colour_of(9)
    assert coverages(picture, [4, 9, 11]) == [
        {(0, 0): 1.0, (1, 0): 1.0},
        {(2, 1): 0.5},
        {},
    ]
    assert coverages(picture, []) == []


def test_colours_are_further_apart_than_a_pixel_may_be_off() -> None:
    palette = np.array([colours.colour_of(number) for number in range(colours.COUNT)], float)
    apart = np.linalg.norm(palette[:, None] - palette[None], axis=2)
    assert apart[~np.eye(len(palette), dtype=bool)].min() > MOST_OFF
    greys = np.arange(256.0)[:, None, None] * np.ones(3)
    assert np.linalg.norm(greys - palette, axis=2).min() > MOST_OFF


@pytest.mark.usefixtures('_eyes')
def test_camera_sees_what_poses_say() -> None:
    orders = [Placement(Block(2, 1), 0), Placement(Block(1, 2), 3)]
    by_camera, by_pose = Robot(BOARD, RobotSettings(perception=CAMERA)), Robot(BOARD)
    for robot in (by_camera, by_pose):
        for order in orders:
            robot.place(order)
            robot.perceive()
    assert by_camera.seen.blocks == by_pose.seen.blocks
    assert by_camera.seen.placed == (Placed(2, 1, 0, 0), Placed(1, 2, 3, 0))
    assert by_camera.seen.warnings == ()


@pytest.mark.usefixtures('_eyes')
def test_film_has_a_frame_for_every_moment_and_shows_what_stands_beside(tmp_path: Path) -> None:
    robot = Robot(BOARD)
    film = Film(robot, every=1.0)
    robot.order(Placement(Block(2, 1), 0))
    while robot.is_busy:
        film.watch(robot.step())
    assert [acts for _, acts in film.frames][-1] == 1
    path = tmp_path / 'film.gif'
    film.save(path, [Image.new('RGB', (100, 100), colour) for colour in ('red', 'blue')])
    with Image.open(path) as written:
        assert getattr(written, 'n_frames', 1) == len(film.frames)
        assert written.width == film.frames[0][0].width + film.frames[0][0].height
    with pytest.raises(ConfigurationError, match='gif'):
        film.save(tmp_path / 'film.txt')
    film.close()
