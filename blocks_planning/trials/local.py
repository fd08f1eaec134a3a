"""A trial inside one process: passes messages between the parts until none is left."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from blocks_planning.search.many import solve_many
from blocks_planning.search.result import CancelToken, Problem, SolveStatus
from blocks_planning.subgoals.proposals import Proposal
from blocks_planning.trials import scribe, searcher, selector, world
from blocks_planning.trials.messages import (
    CancelTrial,
    Message,
    ProposalMade,
    SearchAnswer,
    Solve,
    TrialStarted,
)
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

MOST_AT_ONCE = 1024
"""Most queries that are solved in one call."""
_PARTS = (world, selector, searcher, scribe)


def run_trial(
    spec: TrialSpec,
    cancel: CancelToken | None = None,
    observe: Callable[[Message], None] | None = None,
    proposals: Iterable[Proposal] = (),
) -> TrialRecord:
    """Run a trial to its end.

    Args:
        spec: the trial.
        cancel: ends it, from another thread, with status ``cancelled``.
        observe: called with every message before the parts receive it.
        proposals: of a person, one for each turn. A trial that needs more proposals ends with
            status ``cancelled``.
    """
    cancel = cancel or CancelToken()
    questions: list[Solve] = []
    memories: list[Any] = [part.Memory() for part in _PARTS]
    messages: deque[Message] = deque([TrialStarted(spec.trial_id, spec)])
    cancelling = False
    proposed = iter(proposals)
    while messages:
        message = messages.popleft()
        if observe is not None:
            observe(message)
        if isinstance(message, Solve):
            questions.append(message)
            more = bool(messages) and isinstance(messages[0], Solve)
            if not more or len(questions) == MOST_AT_ONCE:
                messages.extend(_answers(spec, questions, cancel))
                questions = []
        for index, part in enumerate(_PARTS):
            memories[index], said = part.step(memories[index], message)
            messages.extend(said)
        if cancel.cancelled and not cancelling:
            cancelling, questions = True, []
            messages = deque([CancelTrial(spec.trial_id)])
        if not messages and spec.strategy.asks_person and _is_building(memories[-1]):
            messages.append(_next_proposal(spec.trial_id, proposed))
    record: TrialRecord = memories[-1].record()
    return record


def _is_building(memory: scribe.Memory) -> bool:
    return memory.trial is not None and memory.status is TrialStatus.BUILDING


def _next_proposal(trial_id: str, proposals: Iterator[Proposal]) -> Message:
    proposal = next(proposals, None)
    return CancelTrial(trial_id) if proposal is None else ProposalMade(trial_id, proposal)


def _answers(spec: TrialSpec, questions: list[Solve], cancel: CancelToken) -> Iterator[Message]:
    """Solve on all cores; the answers in the order of the questions."""
    problems = [Problem(spec.task, *question.query) for question in questions]
    results = solve_many(problems, spec.search, spec.seed, spec.budget, cancel)
    for question, result in zip(questions, results, strict=True):
        if result.status is SolveStatus.CANCELLED:
            yield CancelTrial(spec.trial_id)
            return
        yield SearchAnswer(spec.trial_id, question.query, result)
