"""A trial inside one process: passes messages between the parts until none is left."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from blocks_planning.external import refuse_external
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


class LocalTrial:
    """A trial that goes on until it ends, or waits for a person.

    Attributes:
        spec: the trial.
    """

    def __init__(
        self,
        spec: TrialSpec,
        cancel: CancelToken | None = None,
        observe: Callable[[Message], None] | None = None,
    ) -> None:
        """Prepare; the first :meth:`say` is that of the :class:`TrialStarted`.

        Args:
            spec: the trial.
            cancel: ends it, from another thread, with status ``cancelled``.
            observe: called with every message before the parts receive it.

        Raises:
            ConfigurationError: for a strategy or search that is another program.
        """
        refuse_external(strategy=spec.strategy, search=spec.search)
        self.spec = spec
        self._cancel = cancel or CancelToken()
        self._observe = observe
        self._memories: list[Any] = [part.Memory() for part in _PARTS]

    @property
    def waits(self) -> bool:
        """Whether it has begun, has not ended and goes on with a proposal of a person."""
        memory: scribe.Memory = self._memories[-1]
        building = memory.trial is not None and memory.status is TrialStatus.BUILDING
        return building and self.spec.strategy.asks_person

    def record(self) -> TrialRecord:
        """The record so far; the trial must have begun."""
        record: TrialRecord = self._memories[-1].record()
        return record

    def say(self, message: Message) -> None:
        """Pass a message to the parts, and all messages that follow from it."""
        questions: list[Solve] = []
        messages: deque[Message] = deque([message])
        cancelling = isinstance(message, CancelTrial)
        while messages:
            message = messages.popleft()
            if self._observe is not None:
                self._observe(message)
            if isinstance(message, Solve):
                questions.append(message)
                more = bool(messages) and isinstance(messages[0], Solve)
                if not more or len(questions) == MOST_AT_ONCE:
                    messages.extend(_answers(self.spec, questions, self._cancel))
                    questions = []
            for index, part in enumerate(_PARTS):
                self._memories[index], said = part.step(self._memories[index], message)
                messages.extend(said)
            if self._cancel.cancelled and not cancelling:
                cancelling, questions = True, []
                messages = deque([CancelTrial(self.spec.trial_id)])


def run_trial(
    spec: TrialSpec,
    cancel: CancelToken | None = None,
    observe: Callable[[Message], None] | None = None,
    proposals: Iterable[Proposal] = (),
) -> TrialRecord:
    """Run a trial to its end.

    Args:
        spec: the trial.
        cancel: see :class:`LocalTrial`.
        observe: see :class:`LocalTrial`.
        proposals: of a person, one for each turn. A trial that needs more proposals ends with
            status ``cancelled``.
    """
    trial = LocalTrial(spec, cancel, observe)
    proposed = iter(proposals)
    trial.say(TrialStarted(spec.trial_id, spec))
    while trial.waits:
        trial.say(_next_proposal(spec.trial_id, proposed))
    return trial.record()


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
