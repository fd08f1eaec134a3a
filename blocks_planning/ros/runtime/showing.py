"""A simulated robot as ROS tools expect it: joints, frames, shapes, pictures, and its clock."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from builtin_interfaces.msg import Time
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CameraInfo, Image, JointState
from std_msgs.msg import Header
from visualization_msgs.msg import MarkerArray

from blocks_planning.errors import ConfigurationError
from blocks_planning.ros.runtime.guarded import GuardedNode
from blocks_planning.ros.wire import qos
from blocks_planning.ros.wire.conversions.robot import (
    camera_to_ros,
    joints_to_ros,
    picture_to_ros,
    shapes_to_ros,
    transforms_to_ros,
)

if TYPE_CHECKING:
    from blocks_planning.robot.rendering import Painter
    from blocks_planning.robot.robot import Robot

PERIOD_S = 0.1
"""Least time between two messages of a topic [s]."""
CAMERA = 'camera'
WIDTH, HEIGHT = 440, 400
"""Size of a picture [pixels]."""


class Shower:
    """Publishes a robot; it shows several of them one after the other, on one clock.

    Attributes:
        time_s: simulated time since the node was started, over all robots [s].
    """

    def __init__(
        self, node: GuardedNode, frame_id: str, camera_period_s: float, has_clock: bool
    ) -> None:
        """Advertise the topics.

        Args:
            node: that publishes.
            frame_id: the frame of the board.
            camera_period_s: least time between two pictures [s]; 0: none.
            has_clock: whether simulated time is published on ``/clock``, and in all headers.
        """
        self._node = node
        self._frame_id = frame_id
        self._camera_period_s = camera_period_s
        self._robot: Robot | None = None
        self._painter: Painter | None = None
        self._began_s = self.time_s = 0.0
        self._shown_s = self._pictured_s = float('-inf')
        self._joints = node.create_publisher(JointState, 'joint_states', qos.stream())
        self._shapes = node.create_publisher(MarkerArray, 'robot/markers', qos.latched_state())
        self._frames, self._frames_type = self._advertise_frames()
        self._clock = node.create_publisher(Clock, '/clock', qos.stream()) if has_clock else None
        self._pictures: Any = None
        if camera_period_s:
            self._pictures = node.create_publisher(Image, 'camera/image_raw', qos.stream())
            self._lens = node.create_publisher(CameraInfo, 'camera/camera_info', qos.stream())

    def _advertise_frames(self) -> tuple[Any, Any]:
        """The publisher of ``/tf`` and its type; None where tf2_msgs is not installed."""
        try:
            kind = import_module('tf2_msgs.msg').TFMessage
        except ModuleNotFoundError:
            self._node.get_logger().info(
                'the module tf2_msgs is not installed: no frames on /tf; it comes with ROS'
            )
            return None, None
        return self._node.create_publisher(kind, '/tf', qos.stream()), kind

    def show(self, robot: Robot, now_s: float) -> None:
        """Publish the robot after each act; during an act only to subscribers, at a limited rate.

        Args:
            robot: after a step, or another one than before.
            now_s: by the steady clock [s].
        """
        is_new = robot is not self._robot
        if is_new:
            if self._painter is not None:
                self._painter.close()
            self._robot, self._painter = robot, None
            self._began_s = self.time_s - robot.time
        self.time_s = self._began_s + robot.time
        if self._clock is not None:
            self._clock.publish(Clock(clock=_time(self.time_s)))
        is_due = now_s - self._shown_s >= PERIOD_S and self._has_listener
        if is_new or is_due or not robot.is_busy:
            self._shown_s = now_s
            robot.simulation.refresh()
            self._show(robot)
            if self._pictures is not None and now_s - self._pictured_s >= self._camera_period_s:
                self._pictured_s = now_s
                self._take_picture(robot)

    @property
    def _has_listener(self) -> bool:
        outlets = (self._joints, self._shapes, self._frames, self._pictures)
        return any(one.get_subscription_count() for one in outlets if one is not None)

    def _header(self, frame_id: str) -> Header:
        if self._clock is None:
            return Header(stamp=self._node.get_clock().now().to_msg(), frame_id=frame_id)
        return Header(stamp=_time(self.time_s), frame_id=frame_id)

    def _show(self, robot: Robot) -> None:
        from blocks_planning.robot.gantry import JOINTS
        from blocks_planning.robot.looking import camera_pose, shapes_of
        from blocks_planning.robot.scene import Pose

        simulation, header = robot.simulation, self._header(self._frame_id)
        positions, speeds = simulation.joints.tolist(), simulation.speeds.tolist()
        self._joints.publish(joints_to_ros(JOINTS, positions, speeds, header))
        self._shapes.publish(shapes_to_ros(shapes_of(simulation), header))
        if self._frames is not None:
            poses = {
                'tool': Pose((positions[0], simulation.sizes.middle, positions[1])),
                CAMERA: camera_pose(simulation),
                **{body.name: simulation.pose(body.number) for body in simulation.bodies},
            }
            self._frames.publish(self._frames_type(transforms=transforms_to_ros(poses, header)))

    def _take_picture(self, robot: Robot) -> None:
        """Publish a picture; where this machine cannot render, say so once."""
        from blocks_planning.robot.looking import focal_length
        from blocks_planning.robot.rendering import Painter
        from blocks_planning.robot.scene import FILM_CAMERA

        try:
            if self._painter is None:
                self._painter = Painter(robot.simulation)
        except ConfigurationError as error:
            self._node.get_logger().warning(f'no pictures on camera/image_raw: {error}')
            self._pictures = None
            return
        header = self._header(CAMERA)
        pixels = self._painter.paint(FILM_CAMERA, WIDTH, HEIGHT)
        self._pictures.publish(picture_to_ros(pixels, header))
        focal = focal_length(robot.simulation, HEIGHT)
        self._lens.publish(camera_to_ros(WIDTH, HEIGHT, focal, header))


def _time(seconds: float) -> Time:
    nanoseconds = round(seconds * 1e9)
    return Time(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)
