"""The tables of a participant, made from the events alone; :mod:`.codebook` has their columns."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from blocks_planning.study.events import Event, EventKind, proposal_of
from blocks_planning.subgoals.proposals import Proposal, ProposalKind, target_of
from blocks_planning.trials.reading import record_from_json
from blocks_planning.trials.record import TrialRecord

Row: TypeAlias = dict[str, Any]
_LONG = ('record', 'points')


@dataclass
class Run:
    """The events of a trial.

    Attributes:
        began: the event of its beginning.
        ended: the event of its end; None if it did not end.
        record: of it; None if it did not end.
        proposed: the events of its proposals.
        refused: number of refused requests.
    """

    began: Event
    ended: Event | None = None
    record: TrialRecord | None = None
    proposed: list[Event] = field(default_factory=list)
    refused: int = 0

    @property
    def is_practice(self) -> bool:
        """Whether it was a practice trial."""
        return bool(self.began.data['phase'] == 'practice')


def runs_of(events: Sequence[Event]) -> list[Run]:
    """The trials among a participant's events, in order.

    Raises:
        RecordError: if a record is not well formed.
    """
    runs: list[Run] = []
    for event in events:
        if event.kind is EventKind.BEGAN:
            runs.append(Run(event))
        elif runs and event.step == runs[-1].began.step:
            _add(runs[-1], event)
    return runs


def _add(run: Run, event: Event) -> None:
    if event.kind is EventKind.PROPOSED:
        run.proposed.append(event)
    elif event.kind is EventKind.REFUSED:
        run.refused += 1
    elif event.kind in (EventKind.ENDED, EventKind.STOPPED) and event.data['record']:
        run.ended = event
        run.record = record_from_json(event.data['record'], f'record at {event.at}')


def tables_of(code: str, status: str, events: Sequence[Event]) -> dict[str, list[Row]]:
    """The rows of each table.

    Args:
        code: of the participant.
        status: of the participant.
        events: of the participant.
    """
    runs = runs_of(events)
    rows = {
        'participants': [_participant(status, events)],
        'trials': [_trial(run) for run in runs],
        'proposals': [row for run in runs for row in _proposals(run)],
        'placements': [row for run in runs for row in _placements(run)],
        'parts': list(_parts(events)),
        'pointer': list(_pointer(events)),
        'events': list(_events(events)),
    }
    return {
        table: [{'participant': code, **row} for row in found] for table, found in rows.items()
    }


def _participant(status: str, events: Sequence[Event]) -> Row:
    return {
        'number': events[0].data['number'],
        'status': status,
        'began_at': events[0].at,
        'last_at': events[-1].at,
        'visits': sum(event.kind is EventKind.ARRIVED for event in events),
    }


def _trial(run: Run) -> Row:
    row: Row = {'step': run.began.step, **run.began.data, 'began_at': run.began.at}
    row |= {'proposals': len(run.proposed), 'refused': run.refused}
    if run.ended is None or run.record is None:
        return {**row, 'status': ''}
    record = run.record
    return {
        **row,
        'ended_at': run.ended.at,
        'status': record.status.value,
        'reason': record.reason,
        'blocks': record.blocks,
        **record.measures._asdict(),
    }


def _proposals(run: Run) -> Iterator[Row]:
    for event in run.proposed:
        yield {
            'step': event.step,
            **event.data,
            'outcome': _outcome(run.record, proposal_of(event)),
            'at': event.at,
            'steady_s': event.steady_s,
        }


def _outcome(record: TrialRecord | None, proposal: Proposal) -> str:
    if record is None or proposal.kind is not ProposalKind.BUILD:
        return ''
    decided = [e.decision for e in record.decisions if e.sequence == proposal.sequence]
    targets = [subgoal.target for decision in decided for subgoal in decision.subgoals]
    wanted = [target_of(record.spec.task, one.built, proposal.region) for one in decided]
    return 'built' if decided and wanted == targets else 'failed'


def _placements(run: Run) -> Iterator[Row]:
    for number, placed in enumerate(run.record.placements if run.record else ()):
        yield {'step': run.began.step, 'placement': number, **placed._asdict()}


def _parts(events: Sequence[Event]) -> Iterator[Row]:
    """The parts that were not taken back, step by step."""
    standing: dict[int, list[Event]] = {}
    for event in events:
        if event.kind is EventKind.MARKED:
            standing.setdefault(event.step, []).append(event)
        elif event.kind is EventKind.UNMARKED:
            del standing[event.step][-1:]
    for step, marked in standing.items():
        for number, event in enumerate(marked):
            times = {'at': event.at, 'steady_s': event.steady_s}
            yield {'step': step, 'part': number} | event.data | times


def _pointer(events: Sequence[Event]) -> Iterator[Row]:
    for event in events:
        if event.kind is EventKind.POINTER:
            for page_s, column, row in event.data['points']:
                yield {'step': event.step, 'page_s': page_s, 'column': column, 'row': row}


def _events(events: Sequence[Event]) -> Iterator[Row]:
    for number, event in enumerate(events):
        data = {key: value for key, value in event.data.items() if key not in _LONG}
        yield {
            'event': number,
            'step': event.step,
            'kind': event.kind.value,
            'at': event.at,
            'steady_s': event.steady_s,
            'data': json.dumps(data, separators=(',', ':')),
        }
