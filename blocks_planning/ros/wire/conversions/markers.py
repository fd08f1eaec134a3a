"""Solids as markers: cells become metres."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from geometry_msgs.msg import Point as RosPoint
from geometry_msgs.msg import Pose, Vector3
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

from blocks_planning.view.solids import Box, Boxes, Lines, Point, Solid, Words

_SPACE_WIDTH = 0.5
"""Width of a space between letters of height 1."""


def markers_to_ros(solids: Iterable[Solid], header: Header, cell_m: float) -> MarkerArray:
    """An array that shows exactly these solids, independent of earlier arrays.

    Args:
        solids: in cells.
        header: of every marker.
        cell_m: the side of a cell [m].
    """
    # The first marker deletes all others. So the latest array is the whole scene, even for a
    # viewer that starts late or has missed some arrays.
    clear = Marker(header=header, action=Marker.DELETEALL)
    return MarkerArray(markers=[clear, *(_marker(solid, header, cell_m) for solid in solids)])


def _marker(solid: Solid, header: Header, cell_m: float) -> Marker:
    marker = Marker(
        header=header,
        ns=solid.layer,
        id=solid.number,
        action=Marker.ADD,
        color=_colour(solid.colour, solid.opacity if isinstance(solid, Boxes) else 1.0),
    )
    for name, value in _shape(solid, cell_m).items():
        setattr(marker, name, value)
    return marker


def _shape(solid: Solid, cell_m: float) -> dict[str, Any]:
    """The fields of a marker that depend on what kind of solid it is."""

    def scaled(kind: type[Any], xyz: Point) -> Any:
        return kind(**dict(zip('xyz', (cell_m * length for length in xyz), strict=True)))

    match solid:
        case Box():
            return {
                'type': Marker.CUBE,
                'pose': Pose(position=scaled(RosPoint, solid.centre)),
                'scale': scaled(Vector3, solid.size),
            }
        case Boxes():
            return {
                'type': Marker.CUBE_LIST,
                'points': [scaled(RosPoint, centre) for centre in solid.centres],
                'scale': scaled(Vector3, solid.size),
            }
        case Lines():
            return {
                'type': Marker.LINE_LIST,
                'points': [scaled(RosPoint, end) for end in solid.ends],
                'scale': scaled(Vector3, (solid.width, 0.0, 0.0)),
            }
        case Words():
            return {
                'type': Marker.TEXT_VIEW_FACING,
                'pose': Pose(position=scaled(RosPoint, solid.centre)),
                # RViz takes x for the width of a space, or one that fits letters of 1 m.
                'scale': scaled(Vector3, (_SPACE_WIDTH * solid.height, 0.0, solid.height)),
                'text': solid.text,
            }
    raise TypeError(f'{type(solid).__name__} cannot be converted to a marker')


def _colour(colour: str, opacity: float) -> ColorRGBA:
    red, green, blue = (level / 255 for level in bytes.fromhex(colour.removeprefix('#')))
    return ColorRGBA(r=red, g=green, b=blue, a=opacity)
