"""What the experimenter's page shows, as JSON."""

from __future__ import annotations

import shutil
from typing import Any

from blocks_planning.study.desk import Desk, Standing
from blocks_planning.study.plan import Step

Json = dict[str, Any]


def overview_json(desk: Desk, has_page: bool, trouble: str) -> Json:
    """The state of a study.

    Args:
        desk: of the study.
        has_page: whether a participant's page is connected.
        trouble: the last thing that went wrong; '' if nothing did.
    """
    session = desk.session
    free = shutil.disk_usage(desk.folder.path).free
    return {
        'title': desk.study.title,
        'study_id': desk.study.study_id,
        'folder': str(desk.folder.path),
        'free_bytes': free,
        'has_page': has_page,
        'trouble': trouble,
        'suggested': desk.suggested(),
        'current': None if session is None else session.participant.code,
        'doing': '' if session is None else _words(session.step),
        'on_step_s': None if session is None else round(session.shown_s),
        'may_begin': session is None or session.step is None,
        'participants': [_standing_json(one) for one in desk.standings()],
    }


def _words(step: Step | None) -> str:
    """What a participant does in a step."""
    if step is None:
        return 'the session is over'
    trial = step.trial or step.marks
    if trial is None:
        return step.kind.value
    phase = 'practice' if trial.is_practice else 'trial'
    doing = 'marks the parts of ' if step.marks else ''
    place = f'{doing}{phase} {trial.number} of {trial.total}'
    return f'{place}, {trial.condition.name}, {trial.spec.stimulus}'


def _standing_json(standing: Standing) -> Json:
    state = standing.state
    return {
        'code': standing.participant.code,
        'number': standing.participant.number,
        'status': 'closed' if state.is_closed else state.status.value,
        'step': state.step,
        'steps': standing.steps,
        'last_at': state.last.at if state.last else '',
        'may_reopen': state.is_closed,
    }
