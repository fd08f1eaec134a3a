"""Regions that a page sends, as pictures, and the check that they have cells to fill."""

from __future__ import annotations

from typing import NamedTuple

from blocks_planning.board.geometry import EMPTY, FILLED, Board, Mask
from blocks_planning.board.task import Task
from blocks_planning.errors import InvalidInput
from blocks_planning.subgoals.proposals import is_filled


class MalformedProposal(InvalidInput):
    """The data from a page is not a proposal."""


class Refused(NamedTuple):
    """Something that a person asked for and that cannot be accepted.

    Attributes:
        code: a word for programs, such as stale, waiting, empty, outside or built.
        reason: a sentence for people.
    """

    code: str
    reason: str


def parse_region(rows: object, board: Board) -> Mask:
    """The cells of a picture: rows of '#' and '.', top row first.

    Raises:
        MalformedProposal: if it is not a picture of this board.
    """
    if (
        not isinstance(rows, list)
        or len(rows) != board.height
        or not all(isinstance(row, str) and len(row) == board.width for row in rows)
        or set().union(*rows) - {FILLED, EMPTY}
    ):
        raise MalformedProposal(
            f'region: expected {board.height} rows of {board.width} cells, each # or .'
        )
    return board.parse(rows)


def judge_region(task: Task, built: Mask, region: Mask) -> Refused | None:
    """Check that a region has cells to fill; return the reason if it has none, else None."""
    if not region:
        return Refused('empty', 'nothing is drawn')
    if not region & task.silhouette:
        return Refused('outside', 'the region is outside the silhouette')
    if is_filled(task, built, region):
        return Refused('built', 'the region is built already')
    return None
