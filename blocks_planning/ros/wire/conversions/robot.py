"""A robot as standard messages: joints, frames, shapes and pictures, in metres and seconds."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from geometry_msgs.msg import Point, Quaternion, Transform, TransformStamped, Vector3
from geometry_msgs.msg import Pose as RosPose
from sensor_msgs.msg import CameraInfo, Image, JointState
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

if TYPE_CHECKING:
    from blocks_planning.robot.looking import Shape
    from blocks_planning.robot.rendering import Pixels
    from blocks_planning.robot.scene import Pose


def joints_to_ros(
    names: Sequence[str], positions: Iterable[float], speeds: Iterable[float], header: Header
) -> JointState:
    """The joints: positions [m] and speeds [m/s]."""
    return JointState(
        header=header, name=list(names), position=list(positions), velocity=list(speeds)
    )


def transforms_to_ros(poses: Mapping[str, Pose], header: Header) -> list[TransformStamped]:
    """Frames by name, each in the frame of the header."""
    return [
        TransformStamped(
            header=header,
            child_frame_id=name,
            transform=Transform(
                translation=_vector(Vector3, pose.position), rotation=_quaternion(pose)
            ),
        )
        for name, pose in poses.items()
    ]


def shapes_to_ros(shapes: Iterable[Shape], header: Header) -> MarkerArray:
    """An array that shows exactly these shapes, independent of earlier arrays."""
    markers = [Marker(header=header, action=Marker.DELETEALL)]
    for number, shape in enumerate(shapes):
        red, green, blue, opacity = shape.colour
        markers.append(
            Marker(
                header=header,
                ns='blocks' if shape.name.startswith('block_') else 'robot',
                id=number,
                type=Marker.CUBE,
                action=Marker.ADD,
                pose=RosPose(
                    position=_vector(Point, shape.pose.position),
                    orientation=_quaternion(shape.pose),
                ),
                scale=_vector(Vector3, shape.size),
                color=ColorRGBA(r=red, g=green, b=blue, a=opacity),
            )
        )
    return MarkerArray(markers=markers)


def picture_to_ros(pixels: Pixels, header: Header) -> Image:
    """A picture, uint8 (height, width, 3), top row first."""
    height, width, _ = pixels.shape
    return Image(
        header=header,
        height=height,
        width=width,
        encoding='rgb8',
        step=3 * width,
        data=pixels.tobytes(),
    )


def camera_to_ros(width: int, height: int, focal_length: float, header: Header) -> CameraInfo:
    """A camera without distortion; its focal length is in pixels."""
    x, y, f = width / 2, height / 2, focal_length
    return CameraInfo(
        header=header,
        width=width,
        height=height,
        distortion_model='plumb_bob',
        d=[0.0] * 5,
        k=[f, 0.0, x, 0.0, f, y, 0.0, 0.0, 1.0],
        r=[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        p=[f, 0.0, x, 0.0, 0.0, f, y, 0.0, 0.0, 0.0, 1.0, 0.0],
    )


def _vector(kind: type[Any], xyz: Iterable[float]) -> Any:
    return kind(**dict(zip('xyz', xyz, strict=True)))


def _quaternion(pose: Pose) -> Quaternion:
    return Quaternion(**dict(zip('wxyz', pose.orientation, strict=True)))
