"""What breadth-first lookahead found in the states of a problem, so that it looks once. Compiled.

Attempts at one problem differ in their draws only, and a region that cannot be filled takes
thousands of them. Looking ahead from a state always gives the same best tree nodes, so they are
kept, and a later attempt only draws among them. It counts the states evaluated as if it had looked.

If there is no room for another decision, it is written after the kept ones and is overwritten by
the next.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from blocks_planning.board.kernels.compiling import inlined
from blocks_planning.board.kernels.masks import digest, load, store

_MOST = 1024
_CHOICES = 16
"""Average number of kept choices of a decision: most states that come up again have few."""


class Decisions(NamedTuple):
    """Decisions by number; the choices of decision i are those from ``first[i]`` to ``first[i + 1]``.

    The moves of a complete path, if ``ending`` is not 0, stand in the place of choices.
    """

    shadow: np.ndarray  # mask (n,)
    filled: np.ndarray  # int64 (n,) [cells]
    evaluated: np.ndarray  # int64 (n,) [states]
    ending: np.ndarray  # int64 (n,); see :func:`.lookahead.look_ahead`
    first: np.ndarray  # int64 (n + 1,)
    move: np.ndarray  # int64 (choices,)
    below: np.ndarray  # int64 (choices,): best tree nodes up to this choice
    slots: np.ndarray  # int32 (2**k,), at least twice n: numbers of decisions plus 1, 0 where free
    kept: np.ndarray  # int64 (1,): number of kept decisions
    move_of: np.ndarray  # int64 (most children,): working memory


def make_decisions(mask_shape: tuple[int, ...], children: int, depth: int) -> Decisions:
    """Memory for the decisions of a problem, in states with up to ``children`` legal placements."""
    choices = _CHOICES * _MOST + children * depth + depth
    return Decisions(
        shadow=np.empty((_MOST, *mask_shape), np.uint64),
        filled=np.empty(_MOST, np.int64),
        evaluated=np.empty(_MOST, np.int64),
        ending=np.empty(_MOST, np.int64),
        first=np.zeros(_MOST + 1, np.int64),
        move=np.empty(choices, np.int64),
        below=np.empty(choices, np.int64),
        slots=np.zeros(2 * _MOST, np.int32),
        kept=np.zeros(1, np.int64),
        move_of=np.empty(children, np.int64),
    )


@inlined
def _slot(decisions, shadow, filled):
    """The slot of a state, or the free slot where it belongs."""
    last = np.uint64(decisions.slots.size - 1)
    slot = digest(shadow) & last
    while decisions.slots[slot] > 0:
        number = decisions.slots[slot] - 1
        if load(decisions.shadow, number) == shadow and decisions.filled[number] == filled:
            break
        slot = (slot + np.uint64(1)) & last
    return slot


@inlined
def forget_decisions(decisions):
    """Drop all decisions."""
    if decisions.kept[0] > 0:
        for slot in range(decisions.slots.size):
            decisions.slots[slot] = 0
        decisions.kept[0] = 0


@inlined
def known(decisions, shadow, filled):
    """The number of the decision in a state, or -1 if it is not kept."""
    return np.int64(decisions.slots[_slot(decisions, shadow, filled)]) - 1


@inlined
def write_head(decisions, shadow, filled, evaluated, ending):
    """Begin a new decision; return its number and the place of its first choice."""
    number = decisions.kept[0]
    store(decisions.shadow, number, shadow)
    decisions.filled[number] = filled
    decisions.evaluated[number] = evaluated
    decisions.ending[number] = ending
    return number, decisions.first[number]


@inlined
def finish(decisions, number, end, room):
    """End a new decision before the choice ``end``; keep it if another one has ``room`` then."""
    decisions.first[number + 1] = end
    if number + 1 < decisions.filled.size and end + room <= decisions.move.size:
        slot = _slot(decisions, load(decisions.shadow, number), decisions.filled[number])
        decisions.slots[slot] = number + 1
        decisions.kept[0] = number + 1
