"""Node ``action_searcher``: plans how to fill a region, and orders the placements.

Searches run in worker threads, so that the node stays responsive; they stop as soon as their trial
is over. The kernels of a search are compiled in such a thread too, before it is first run: those of
the default search when the node starts.

| | |
|---|---|
| subscribes | `trial`, `state`, `subgoal`, `hold`, `outcome` (latched), `search/request` (stream) |
| publishes | `search/result`, `action` (stream), `plan` (latched) |
| action | `plan_tower`: plans a tower without building it |
| parameters | `remind_period_s`; `frame_id`; `workers`: number of searches that run at once |
"""

from __future__ import annotations

import threading
from collections import deque
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any, TypeAlias

from blocks_planning.board.geometry import Board
from blocks_planning.ros.runtime.diagnostics import Health
from blocks_planning.ros.runtime.parameters import Parameter
from blocks_planning.ros.runtime.part_node import PartNode
from blocks_planning.ros.runtime.planning import PlanServer
from blocks_planning.ros.runtime.process import run
from blocks_planning.ros.wire.graph import ACTION_SEARCHER
from blocks_planning.search.many import solve_many
from blocks_planning.search.result import CancelToken, Problem, SolveResult, SolveStatus
from blocks_planning.search.searches import BreadthFirst, Search
from blocks_planning.search.warming import Kernels
from blocks_planning.trials import searcher
from blocks_planning.trials.messages import (
    Message,
    SearchAnswer,
    Solve,
    TrialEnded,
    TrialStarted,
)

WORKERS = Parameter('workers', 2, 'Number of searches that run at once.', (1, 64))


MOST_AT_ONCE = 32
"""Most queries that a thread solves in one call."""
_Question: TypeAlias = 'tuple[TrialStarted, Solve, CancelToken]'


class ActionSearcher(PartNode):
    """The searcher, with threads to search in."""

    def __init__(self, **options: Any) -> None:
        """See :class:`PartNode`."""
        super().__init__(ACTION_SEARCHER, searcher, (WORKERS,), **options)
        self._cancel = CancelToken()
        self._threads = ThreadPoolExecutor(self.values['workers'], 'search')
        self._kernels = Kernels(self.get_logger().info)
        self._plans = PlanServer(self, self._kernels)
        self._waiting: deque[_Question] = deque()
        self._answers: deque[SearchAnswer | BaseException] = deque()
        self._counting = threading.Lock()
        self._running = 0
        self._evaluated = 0

    def prepare(self, search: Search, board: Board) -> None:
        """Compile the kernels of a search in a thread; it is not run before."""
        self._threads.submit(self._prepare, search, board)

    def begin(self, trial: TrialStarted) -> None:
        """Begin a trial: cancel the searches of other trials."""
        if self.trial is None or self.trial.trial_id != trial.trial_id:
            self._stop_searching()
            self.prepare(trial.spec.search, trial.spec.task.board)
        super().begin(trial)

    def take(self, message: Message) -> None:
        """See :class:`PartNode`."""
        if isinstance(message, TrialEnded):
            self._stop_searching()
        super().take(message)

    def perform(self, message: Message) -> None:
        """Search in a thread; the answer returns to the thread of the node."""
        assert isinstance(message, Solve)
        assert self.trial is not None
        self._waiting.append((self.trial, message, self._cancel))
        self._threads.submit(self._search_some)

    def health(self) -> Health:
        """See :class:`PartNode`; the state is ``compiling`` until searches can be run."""
        health = super().health()
        return replace(health, state='compiling') if self._kernels.compiling else health

    def load(self) -> dict[str, object]:
        """See :class:`PartNode`; counts of the searches of the trial."""
        running = self._running
        return {
            'searches_running': running,
            'searches_waiting': max(0, len(self.memory.solving) - running),
            'searches_done': len(self.memory.known),
            'states_evaluated': self._evaluated,
        }

    def _prepare(self, search: Search, board: Board) -> None:
        try:
            self._kernels.prepare(search, board)
        except BaseException as error:  # noqa: BLE001  raised again in the node's own thread
            self._answers.append(error)
            self.call_soon(self._deliver)

    def _search_some(self) -> None:
        """Take questions of a trial from those that wait, and solve them in one call."""
        questions = self._take_questions()
        if not questions:
            return
        trial, _, cancel = questions[0]
        spec = trial.spec
        queries = [question.query for _, question, _ in questions]
        problems = [Problem(spec.task, *query) for query in queries]

        def done(index: int, result: SolveResult) -> None:
            self._count_running(-1)
            if result.status is not SolveStatus.CANCELLED:
                self._answers.append(SearchAnswer(trial.trial_id, queries[index], result))
                self.call_soon(self._deliver)

        try:
            self._kernels.prepare(spec.search, spec.task.board)
            solve_many(problems, spec.search, spec.seed, spec.budget, cancel, done, workers=1)
        except BaseException as error:  # noqa: BLE001  raised again in the node's own thread
            self._answers.append(error)
            self.call_soon(self._deliver)

    def _take_questions(self) -> list[_Question]:
        """Questions of the trial of the first one; their number grows with the number that wait."""
        with self._counting:
            most = min(MOST_AT_ONCE, -(-len(self._waiting) // (2 * self.values['workers'])))
            taken: list[_Question] = []
            while len(taken) < most and self._waiting:
                if taken and self._waiting[0][2] is not taken[0][2]:
                    break
                taken.append(self._waiting.popleft())
            self._running += len(taken)
        return taken

    def _count_running(self, change: int) -> None:
        with self._counting:
            self._running += change

    def _deliver(self) -> None:
        while self._answers:
            answer = self._answers.popleft()
            if isinstance(answer, BaseException):
                raise answer
            self._evaluated += answer.result.planning_cost
            if self.trial is not None and answer.trial_id == self.trial.trial_id:
                self.say(answer)
                self.take(answer)

    def _stop_searching(self) -> None:
        with self._counting:
            self._waiting.clear()
        self._cancel.cancel()
        self._cancel = CancelToken()


def main() -> None:
    """Run the node until SIGINT or SIGTERM."""

    def make_node(_: threading.Event) -> ActionSearcher:
        node = ActionSearcher()
        node.prepare(BreadthFirst(), Board(8, 8))  # most trials have this search
        return node

    run(make_node)


if __name__ == '__main__':
    main()
