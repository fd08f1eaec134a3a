"""The frame that the server sends to the page several times a second."""

from __future__ import annotations

from typing import NamedTuple

from blocks_planning.board.geometry import area
from blocks_planning.search.result import SolveResult
from blocks_planning.subgoals.proposals import Proposal, ProposalKind, target_of
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view import captions
from blocks_planning.view.scene import Scene
from blocks_planning.view.web import pictures
from blocks_planning.view.web.health import NOTHING, Health, health_json
from blocks_planning.view.web.pictures import Json
from blocks_planning.view.web.queue import Place
from blocks_planning.view.web.session import Session, Turn, answer_to, turn_of
from blocks_planning.worlds.observation import mask_of, standing

MOST_WORDS = 20
"""Number of proposals that are listed, the last ones."""


class Seen(NamedTuple):
    """Everything that the page shows at one moment."""

    session: Session = Session()
    health: Health = NOTHING
    place: Place = Place(None, 0, ())


def hides_costs(session: Session) -> bool:
    """Whether planning costs of any trial must not be sent now.

    True from the start of a trial that hides its costs until another one begins.
    """
    return session.scene is not None and session.scene.spec.strategy.hides_costs


def frame_json(seen: Seen, now_s: float) -> Json:
    """The current frame as JSON.

    Args:
        seen: everything to show.
        now_s: time on the clock of the health [s].
    """
    session, place = seen.session, seen.place
    hidden = hides_costs(session)
    frame: Json = {
        'kind': 'frame',
        'phase': _phase(session),
        'index': place.number,
        'total': place.total,
        'coming': [
            {'stimulus': spec.stimulus, 'strategy': captions.strategy_of(spec)}
            for spec in place.coming
        ],
        'past': session.count,
        'health': health_json(seen.health, now_s, hidden),
        'trial': None,
    }
    if session.scene is None:
        return frame
    scene = session.scene
    return {
        **frame,
        'trial': pictures.trial_json(scene.spec, scene.trial.trial_id),
        'all_blocks': pictures.blocks_json(scene),
        'decision': None
        if scene.decision is None
        else pictures.decision_json(scene.decision, hidden),
        'curve': pictures.curve_json(scene.record, hidden),
        'step': pictures.step_json(scene, hidden),
        'turn': _turn_json(turn_of(session)),
        'proposals': _proposals_json(session, scene, hidden),
    }


def _phase(session: Session) -> str:
    if session.scene is None:
        return 'waiting'
    return 'running' if session.scene.status is TrialStatus.BUILDING else 'between'


def _turn_json(turn: Turn | None) -> Json | None:
    if turn is None:
        return None
    return {'sequence': turn.sequence, 'number': turn.number, 'waiting': turn.is_waiting}


def _proposals_json(session: Session, scene: Scene, hidden: bool) -> list[Json]:
    """The person's proposals in this trial, with their outcomes."""
    decided = scene.record.proposals
    last = scene.chosen.decisions[-1].sequence if scene.chosen is not None else -1
    said = [*decided, *(p for p in session.proposals if p.sequence > last)]
    return [_told(session, scene, proposal, hidden) for proposal in said[-MOST_WORDS:]]


def _told(session: Session, scene: Scene, proposal: Proposal, hidden: bool) -> Json:
    board = scene.task.board
    built = _built_at(session, scene, proposal.sequence)
    target = target_of(scene.task, built, proposal.region)
    answer = answer_to(session, proposal, built)
    told = pictures.proposal_json(board, proposal)
    told |= {'cells': area(target) - area(built), 'outcome': _outcome(scene, proposal, answer)}
    if answer is not None and not hidden:
        told |= {'cost': answer.planning_cost, 'word': captions.SOLVE_WORDS[answer.status]}
    return told


def _outcome(scene: Scene, proposal: Proposal, answer: SolveResult | None) -> str:
    """The outcome of a proposal, as a word for the page."""
    if proposal.kind is not ProposalKind.BUILD:
        return str(proposal.kind.value)
    if answer is not None:
        return 'built' if answer.solved else 'failed'
    entries = () if scene.chosen is None else scene.chosen.decisions
    taken = [entry.decision for entry in entries if entry.sequence == proposal.sequence]
    if not taken:
        return 'searching'
    # It was answered before this server started.
    target = target_of(scene.task, taken[0].built, proposal.region)
    return 'built' if target in [subgoal.target for subgoal in taken[0].subgoals] else 'failed'


def _built_at(session: Session, scene: Scene, sequence: int) -> int:
    """The filled cells in the state of an observation."""
    if session.state is not None and session.state.sequence == sequence:
        return session.state.built
    return mask_of(scene.task.board, standing(scene.observations[: sequence + 1]))
