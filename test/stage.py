"""A graph in one process, with the page in front of it: what a test shows to a browser."""

from __future__ import annotations

from collections import deque
from concurrent.futures import Future
from typing import Any

from blocks_planning.errors import InvalidInput
from blocks_planning.search.result import Problem
from blocks_planning.search.solve import solve
from blocks_planning.subgoals.drawn import Refused
from blocks_planning.trials import scribe, searcher, selector, world
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.messages import (
    Message,
    ProposalMade,
    SearchAnswer,
    Solve,
    TrialEnded,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.view.web.frame import Seen
from blocks_planning.view.web.guards import Address
from blocks_planning.view.web.health import NOTHING, Health
from blocks_planning.view.web.live import Mailbox
from blocks_planning.view.web.proposing import judge, parse
from blocks_planning.view.web.queue import Queue
from blocks_planning.view.web.server import PageServer
from blocks_planning.view.web.session import Session, session_after, with_told_again

_PARTS = (world, selector, searcher, scribe)
_LATCHED = (TrialStarted, WorldState, SubgoalChosen, TrialEnded)


class Stage:
    """Trials that are shown as they run; a trial of a person waits for what is proposed.

    Attributes:
        held: searches are not carried out while this is true.
        records: of the trials that ended.
    """

    def __init__(self, specs: tuple[TrialSpec, ...] = (), port: int = 0) -> None:
        """Serve; nothing has run yet."""
        self.session = Session()
        self.health: Health = NOTHING
        self.held = False
        self.records: list[TrialRecord] = []
        self.proposed: list[Any] = []
        self.heard: list[Message] = []
        self._queue = Queue(specs)
        self._waiting: deque[Message] = deque()
        self.mailbox = Mailbox()
        self.server = PageServer(Address(port=port), self.mailbox, self._propose)
        self._show()
        self.server.start()
        self.url = self.server.address.url

    def run(self, spec: TrialSpec) -> None:
        """Run a trial as far as it goes without a person."""
        self._memories = [part.Memory() for part in _PARTS]
        self.heard = []
        self._spec = spec
        self._say(TrialStarted(spec.trial_id, spec))

    def release(self) -> None:
        """Carry out the searches that were held."""
        self.held = False
        waiting, self._waiting = self._waiting, deque()
        self._say(*waiting)

    def forget(self) -> None:
        """As a page does that was killed: what is latched is all that it hears again."""
        self.session = Session()
        for kind in _LATCHED:
            for message in [m for m in self.heard if isinstance(m, kind)][-1:]:
                self.session = session_after(self.session, message)
        self._show()

    def show_health(self, health: Health) -> None:
        """Show how nodes are."""
        self.health = health
        self._show()

    def crash(self) -> None:
        """End the server without a word."""
        self.server._audience._clients.clear()
        self.server.stop()

    def _say(self, *messages: Message) -> None:
        said: deque[Message] = deque(messages)
        while said:
            message = said.popleft()
            if isinstance(message, Solve):
                if self.held:
                    self._waiting.append(message)
                    continue
                said.append(self._answer(message))
            self.heard.append(message)
            self.session = session_after(self.session, message)
            self._show()
            for index, part in enumerate(_PARTS):
                self._memories[index], answers = part.step(self._memories[index], message)
                said.extend(answers)
            if isinstance(message, TrialEnded):
                self.records.append(self._memories[-1].record())

    def _answer(self, question: Solve) -> SearchAnswer:
        spec = self._spec
        problem = Problem(spec.task, *question.query)
        result = solve(problem, spec.search, spec.seed, spec.budget)
        return SearchAnswer(question.trial_id, question.query, result)

    def _propose(self, data: Any) -> Future[Refused | None]:
        """As the node does."""
        self.proposed.append(data)
        answer: Future[Refused | None] = Future()
        try:
            answer.set_result(self._judged(data))
        except InvalidInput as error:
            answer.set_exception(error)
        return answer

    def _judged(self, data: Any) -> Refused | None:
        posted = parse(data, self._spec.task.board)
        refused = judge(self.session, posted)
        if refused is None:
            assert isinstance(posted.said, ProposalMade)
            self._say(posted.said)
            if posted.is_again:
                self.session = with_told_again(self.session)
                self._show()
        return refused

    def _show(self) -> None:
        place = self._queue.place_of(self.session.trial_id)
        self.mailbox.put(Seen(self.session, self.health, place))
