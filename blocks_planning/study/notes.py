"""What a participant's page tells of itself: it changes nothing, and is kept."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from blocks_planning.board.geometry import Board
from blocks_planning.errors import shown
from blocks_planning.study.events import EventKind
from blocks_planning.study.modes import Fields
from blocks_planning.subgoals.drawn import MalformedProposal, parse_region

MOST_POINTS = 100
"""Most points of one note; a page sends ten a second, every two seconds."""
_FAR = 1e6


def _pointer(fields: Fields, board: Board | None) -> dict[str, Any]:
    points = fields.get('points')
    if not isinstance(points, list) or not 1 <= len(points) <= MOST_POINTS:
        raise MalformedProposal(f'points: expected 1 to {MOST_POINTS} points, got {shown(points)}')
    if not all(isinstance(point, list) and len(point) == 3 for point in points):
        raise MalformedProposal('points: expected [seconds, column, row] each')
    return {'points': [[_number(value) for value in point] for point in points]}


def _number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) < _FAR:
        raise MalformedProposal(f'points: expected numbers, got {shown(value)}')
    return round(float(value), 3)


def _preview(fields: Fields, board: Board | None) -> dict[str, Any]:
    if board is None:
        raise MalformedProposal('preview: no trial is running')
    return {'region': hex(parse_region(fields.get('region'), board))}


def _visible(fields: Fields, board: Board | None) -> dict[str, Any]:
    visible = fields.get('visible')
    if type(visible) is not bool:
        raise MalformedProposal(f'visible: expected true or false, got {shown(visible)}')
    return {'visible': visible}


_NOTES: Mapping[str, tuple[EventKind, Callable[[Fields, Board | None], dict[str, Any]]]] = (
    MappingProxyType(
        {
            'pointer': (EventKind.POINTER, _pointer),
            'preview': (EventKind.PREVIEW, _preview),
            'visible': (EventKind.VISIBLE, _visible),
        }
    )
)


def read_note(fields: Fields, board: Board | None) -> tuple[EventKind, dict[str, Any]]:
    """The kind and the data of a note's event.

    Args:
        fields: what the page sent.
        board: of the trial that runs; None: none does.

    Raises:
        MalformedProposal: if it is not a note.
    """
    word = fields.get('note')
    if not isinstance(word, str) or word not in _NOTES:
        raise MalformedProposal(f'note: expected one of {", ".join(_NOTES)}, got {shown(word)}')
    kind, read = _NOTES[word]
    return kind, read(fields, board)


def read_seconds(fields: Fields, key: str) -> float:
    """A number of seconds of 0 or more.

    Raises:
        MalformedProposal: if it is not one.
    """
    value: object = fields.get(key)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value < math.inf:
        raise MalformedProposal(f'{key}: expected a number of 0 or more, got {shown(value)}')
    return float(value)
