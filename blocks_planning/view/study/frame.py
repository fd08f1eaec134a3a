"""What a participant's page shows, as JSON: the step, and nothing of others, nodes or searches."""

from __future__ import annotations

from typing import Any

from blocks_planning.board import rules
from blocks_planning.board.blocks import Block
from blocks_planning.study.machine import State, Status
from blocks_planning.study.plan import StepKind, Trial
from blocks_planning.study.session import Session
from blocks_planning.study.texts import parse_text
from blocks_planning.subgoals.proposals import ProposalKind
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view import palette

Json = dict[str, Any]


def frame_json(title: str, session: Session | None) -> Json:
    """The current frame.

    Args:
        title: of the study.
        session: of the participant; None: no session is open.
    """
    frame: Json = {'kind': 'frame', 'title': title, 'stage': 'waiting', 'text': [], 'trial': None}
    if session is None:
        return frame
    state, step = session.state, session.step
    frame |= {'acts': state.acts, 'step': state.step, 'steps': len(session.steps)}
    if step is None:
        return {**frame, 'stage': state.status.value}
    frame |= {'stage': step.kind.value, 'text': text_json(step.text)}
    frame['may_stop'] = step.kind not in (StepKind.CONSENT, StepKind.DEBRIEF)
    frame['stopped'] = state.status is Status.STOPPED
    if step.trial is not None and session.record is not None:
        frame['trial'] = _trial_json(step.trial, session.record, session)
    if step.marks is not None:
        frame['trial'] = _marking_json(step.marks, state)
    return frame


def text_json(text: str) -> list[Json]:
    """A text as blocks of lines of words with the names of their elements."""
    return [
        {'tag': block.tag, 'lines': [[list(span) for span in line] for line in block.lines]}
        for block in parse_text(text)
    ]


def _trial_json(trial: Trial, record: TrialRecord, session: Session) -> Json:
    task, state = trial.spec.task, session.state
    shown: Json = {
        **_silhouette_json(trial, state),
        'library': [list(block) for block in task.library],
        'wishes': list(trial.condition.mode.wishes),
        'all_blocks': _blocks_json(record),
        'sequence': len(record.observations) - 1,
        'proposals': len(state.proposals),
        'answer': _answer(record, state),
        'status': record.status.value if state.is_ended else TrialStatus.BUILDING.value,
        'timed_out': state.is_timed_out,
        'left_s': session.left_s,
        'limit_s': trial.condition.time_limit_s,
    }
    if 'place' in trial.condition.mode.wishes:
        shown['places'] = [_places(record, block) for block in task.library]
    return shown


def _silhouette_json(trial: Trial, state: State) -> Json:
    """What is shown of a trial, and of the marking of its parts."""
    board = trial.spec.task.board
    phase = 'Practice tower' if trial.is_practice else 'Tower'
    return {
        'id': state.step,
        'stimulus': f'{phase} {trial.number} of {trial.total}',
        'width': board.width,
        'height': board.height,
        'silhouette': board.draw(trial.spec.task.silhouette).split('\n'),
    }


def _marking_json(trial: Trial, state: State) -> Json:
    """The marking of a silhouette: every cell of a part is shown in the part's colour."""
    task = trial.spec.task
    return {
        **_silhouette_json(trial, state),
        'library': [],
        'wishes': ['mark', 'unmark'],
        'all_blocks': [
            {'width': 1, 'height': 1, 'column': column, 'row': row, **_colours(number)}
            for number, part in enumerate(state.parts)
            for column, row in task.board.cells(part)
        ],
        'sequence': len(state.parts),
        'proposals': state.acts,
        'answer': 'marked' if state.marked == task.silhouette else '',
        'status': TrialStatus.BUILDING.value,
        'timed_out': False,
        'left_s': None,
        'limit_s': 0,
    }


def _colours(number: int) -> Json:
    """The number and the colours of what belongs to a subgoal or a part, numbered from 0."""
    fill = palette.colour_of(number)
    return {'subgoal': number, 'fill': fill, 'ink': palette.ink_on(fill)}


def _places(record: TrialRecord, block: Block) -> list[list[Any]]:
    """Where a block would come to rest in each column: its row, and whether it may stand there."""
    task = record.spec.task
    placements = rules.possible_placements(task.board, record.built, (block,))
    return [
        [placed.column, placed.row, not rules.cells_of(task.board, placed) & ~task.silhouette]
        for placed in placements
    ]


def _blocks_json(record: TrialRecord) -> list[Json]:
    """The blocks that stand, in the colour of the proposal that they come from."""
    starts = [entry.sequence for entry in record.decisions]
    found = []
    for index, placed in enumerate(record.placements):
        subgoal = sum(start <= index for start in starts) - 1
        found.append({**placed._asdict(), **_colours(subgoal)})
    return found


def _answer(record: TrialRecord, state: State) -> str:
    """What became of the last proposal, as a word; '' if there is none."""
    if not state.proposals:
        return ''
    last = state.proposals[-1]
    if last.kind is not ProposalKind.BUILD:
        return str(last.kind.value)
    return 'built' if len(record.observations) - 1 > last.sequence else 'failed'
