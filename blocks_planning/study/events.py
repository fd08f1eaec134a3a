"""The events of a participant's session, one per line, in order.

The state of a session follows from its events alone (:mod:`.machine`), so a session that was
interrupted, by whatever, goes on from its file.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from datetime import datetime, timezone
from enum import Enum
from typing import Any, NamedTuple

from blocks_planning.errors import RecordError
from blocks_planning.subgoals.proposals import Proposal
from blocks_planning.trials.fields import Fields
from blocks_planning.trials.version2 import read_proposal


class EventKind(str, Enum):
    """What happened; the keys in brackets stand beside those of every event."""

    OPENED = 'opened'
    """A server opened the session (study_id, participant, number)."""
    ARRIVED = 'arrived'
    """The participant's page is connected."""
    LEFT = 'left'
    """The participant's page is not connected any more."""
    AGREED = 'agreed'
    """The participant agreed to take part."""
    DECLINED = 'declined'
    """The participant did not agree; the session is over."""
    WENT_ON = 'went_on'
    """The participant went on to the next step."""
    MARKED = 'marked'
    """A part was marked (phase, condition, tower, region, cells: its own, thinking_s)."""
    UNMARKED = 'unmarked'
    """The last part was taken back."""
    BEGAN = 'began'
    """A trial began (the keys of :meth:`.Trial.to_json`)."""
    PROPOSED = 'proposed'
    """The participant made a proposal (the keys of :func:`.proposal_to_json`)."""
    REFUSED = 'refused'
    """A request was refused (wish, code, region)."""
    TIMED_OUT = 'timed_out'
    """The time limit of the trial was reached."""
    ENDED = 'ended'
    """The trial ended (record)."""
    STOPPED = 'stopped'
    """The participant stopped taking part (record: of the trial that ran, or null)."""
    FINISHED = 'finished'
    """The participant went on from the last step; the session is over."""
    CLOSED = 'closed'
    """The experimenter closed the session; it can be opened again."""
    POINTER = 'pointer'
    """Where the pointer was on the board (points: [seconds on the page, column, row])."""
    PREVIEW = 'preview'
    """A region was drawn, or a block held over the board (region)."""
    VISIBLE = 'visible'
    """The page came into view, or went out of it (visible)."""


class Moment(NamedTuple):
    """A moment on the wall clock [s since 1970] and on a monotonic clock [s]."""

    wall_s: float
    steady_s: float


@dataclass(frozen=True)
class Event:
    """An event of a session.

    Attributes:
        kind: what.
        step: of the participant's steps, from 0.
        at: when, in UTC, as text.
        steady_s: when, on the steady clock of the machine [s]; its zero is another one after the
            machine was started again.
        data: more of it, by name.
    """

    kind: EventKind
    step: int
    at: str
    steady_s: float
    data: dict[str, Any]

    def to_line(self) -> bytes:
        """The event as one line of JSON, without its end."""
        found = {
            'event': self.kind.value,
            'step': self.step,
            'at': self.at,
            'steady_s': self.steady_s,
            **self.data,
        }
        return json.dumps(found, separators=(',', ':'), allow_nan=False).encode()


def event_of(kind: EventKind, step: int, moment: Moment, data: dict[str, Any]) -> Event:
    """An event that happens at a moment."""
    at = datetime.fromtimestamp(moment.wall_s, timezone.utc).isoformat(timespec='milliseconds')
    return Event(kind, step, at.replace('+00:00', 'Z'), round(moment.steady_s, 3), data)


def read_event(line: bytes, place: str) -> Event:
    """The event that :meth:`Event.to_line` wrote.

    Raises:
        RecordError: beginning with ``place``, if it is not an event.
    """
    try:
        fields = Fields(json.loads(line), place)
    except (ValueError, RecursionError):
        raise RecordError(f'{place}: is not JSON; move the folder away') from None
    own = {'event', 'step', 'at', 'steady_s'}
    return Event(
        kind=fields.word('event', EventKind),
        step=fields.count('step'),
        at=fields.get('at', str),
        steady_s=fields.get('steady_s', float),
        data={key: value for key, value in fields.data.items() if key not in own},
    )


def proposal_of(event: Event) -> Proposal:
    """The proposal of such an event."""
    return read_proposal(Fields(event.data, f'event at {event.at}'), 'sequence')
