"""Node ``trial_view``: a page that shows the trials, and on which a person can plan.

The node subscribes to the graph and puts the current session into a mailbox; a server in its own
thread shows it (:mod:`blocks_planning.view.web`). The node checks the proposals from the page
against its session, and publishes the valid ones.

| | |
|---|---|
| subscribes | `trial`, `state`, `subgoal/proposal`, `subgoal`, `outcome` (latched) |
| publishes | `subgoal/proposal` (latched) |
| also subscribes | `/diagnostics` of the nodes in its namespace; `search/result`, unless its script has no trial of a person (the answers are many) |
| parameters | `remind_period_s`; `frame_id`; `host`: address to listen on, other than this machine needs a token; `port`: port to listen on, 0: any free one; `token`: access token, '': that of the environment, or a new one if one is needed; `script`: trial script, to count its trials, '': no count; `participant`: code of the person of its trials, '': as in the script |
"""

from __future__ import annotations

import os
import time
from collections import deque
from concurrent.futures import Future
from contextlib import suppress
from pathlib import Path
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray

from blocks_planning.errors import InvalidInput
from blocks_planning.ros.runtime.diagnostics import TOPIC as DIAGNOSTICS
from blocks_planning.ros.runtime.guarded import read_message
from blocks_planning.ros.runtime.parameters import Parameter
from blocks_planning.ros.runtime.part_node import PartNode
from blocks_planning.ros.runtime.process import run
from blocks_planning.ros.runtime.processes import PARENT_VARIABLE
from blocks_planning.ros.wire import qos
from blocks_planning.ros.wire.graph import TRIAL_VIEW
from blocks_planning.ros.wire.topics import SEARCH_RESULT, Topic
from blocks_planning.subgoals.drawn import Refused
from blocks_planning.trials.messages import Message
from blocks_planning.trials.script import read_script
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view.web import session
from blocks_planning.view.web.frame import Seen
from blocks_planning.view.web.guards import address_of
from blocks_planning.view.web.health import NOTHING, health_after
from blocks_planning.view.web.proposing import Posted, judge, parse
from blocks_planning.view.web.queue import Queue

HOST = Parameter(
    'host', '127.0.0.1', 'Address to listen on; other than this machine needs a token.'
)
PORT = Parameter('port', 0, 'Port to listen on; 0: any free one.', (0, 65535))
TOKEN = Parameter('token', '', 'Access token; none: that of the environment, or a new one.')
SCRIPT = Parameter('script', '', 'Trial script, to count its trials; none: no count.')
PARTICIPANT = Parameter('participant', '', 'Code of the person; none: as in the script.')
PARAMETERS = (HOST, PORT, TOKEN, SCRIPT, PARTICIPANT)
TOKEN_VARIABLE = 'BLOCKS_PLANNING_VIEW_TOKEN'
"""Environment variable of the token: process arguments can be read by every user of the machine."""
NICENESS = 10


class TrialView(PartNode):
    """The session, with a server that shows it."""

    MOST_KNOWN = 1 + session.MOST_LATE

    def __init__(self, **options: Any) -> None:
        """See :class:`PartNode`.

        Raises:
            ConfigurationError: also if the page can't be served at the address, or the extra
                ``page`` is not installed.
        """
        from blocks_planning.view.web.live import Mailbox
        from blocks_planning.view.web.server import PageServer

        super().__init__(TRIAL_VIEW, session, PARAMETERS, **options)
        script, participant = self.values['script'], self.values['participant']
        specs = read_script(Path(script), participant) if script else []
        self._queue = Queue(specs)
        if not script or any(_is_persons(spec) for spec in specs):
            self.listen(SEARCH_RESULT)
        self._health = NOTHING
        self._place = self._queue.place_of(None)
        self._posted: deque[tuple[Any, Future[Refused | None]]] = deque()
        self._mailbox = Mailbox()
        self.create_subscription(
            DiagnosticArray, DIAGNOSTICS, self._receive_health, qos.stream(), raw=True
        )
        token = self.values['token'] or os.environ.get(TOKEN_VARIABLE, '')
        address = address_of(self.values['host'], self.values['port'], token)
        self.page = PageServer(address, self._mailbox, self._post)
        self._show()
        self.page.start()
        if (
            PARENT_VARIABLE not in os.environ
        ):  # otherwise the process that started this one prints it
            self.get_logger().info(f'the page is at {self.page.address.url}')

    @property
    def is_busy(self) -> bool:
        """See :class:`PartNode`."""
        scene = self.memory.scene
        return scene is not None and scene.status is TrialStatus.BUILDING

    def load(self) -> dict[str, object]:
        """See :class:`PartNode`."""
        return {'browsers': self.page.clients, 'trials_kept': len(self.memory.past)}

    def cares_for(self, topic: Topic, spec: TrialSpec) -> bool:
        """See :class:`PartNode`; only answers to a person's proposals are converted."""
        return topic is not SEARCH_RESULT or _is_persons(spec)

    def take(self, message: Message) -> None:
        """See :class:`PartNode`."""
        before = self.memory
        super().take(message)
        if self.memory is not before:
            if self.memory.trial_id != before.trial_id:
                self._place = self._queue.place_of(self.memory.trial_id)
            self._show()

    def _show(self) -> None:
        self._mailbox.put(Seen(self.memory, self._health, self._place))

    def _receive_health(self, data: bytes) -> None:
        try:
            self._take_health(read_message(DiagnosticArray, data))
        except InvalidInput as error:
            self.refuse(f'a message on {DIAGNOSTICS}', error)

    def _take_health(self, message: DiagnosticArray) -> None:
        """Take the diagnostics of a node of this graph."""
        space = self.get_namespace().rstrip('/') + '/'
        for status in message.status:
            if status.name.startswith(space):
                self._health = health_after(
                    self._health,
                    status.name.removeprefix(space),
                    int.from_bytes(status.level, 'little'),
                    status.message,
                    ((value.key, value.value) for value in status.values),
                    time.monotonic(),
                )
        self._show()

    def _post(self, data: Any) -> Future[Refused | None]:
        """Called in the thread of the server: pass a proposal to the thread of the node."""
        answer: Future[Refused | None] = Future()
        self._posted.append((data, answer))
        self.call_soon(self._take_posted)
        return answer

    def _take_posted(self) -> None:
        while self._posted:
            data, answer = self._posted.popleft()
            if answer.set_running_or_notify_cancel():
                try:
                    answer.set_result(self._propose(data))
                except InvalidInput as error:
                    answer.set_exception(error)

    def _propose(self, data: Any) -> Refused | None:
        """Publish a proposal if it is valid; otherwise return the reason."""
        if self.trial is None:
            return Refused('stale', 'no trial has begun')
        posted = parse(data, self.board)
        refused = judge(self.memory, posted)
        if refused is None:
            self._say_posted(posted)
        return refused

    def _say_posted(self, posted: Posted) -> None:
        self.say(posted.said)
        self.take(posted.said)
        if posted.is_again:
            self.memory = session.with_told_again(self.memory)
            self._show()

    def finish(self) -> None:
        """Before shutdown: tell the browsers that the session is over."""
        self.page.stop()


def _is_persons(spec: TrialSpec) -> bool:
    return spec.strategy.asks_person


def stand_back() -> None:
    """Lower the priority of this process, so that the page does not slow down the trials.

    If the system schedules by session, the niceness of a process matters only within its session;
    so the niceness of the session, which the bring-up creates for each process, is set too.
    """
    os.setpriority(os.PRIO_PROCESS, 0, NICENESS)
    if os.getsid(0) == os.getpid():
        with suppress(OSError):  # not available on this system
            Path('/proc/self/autogroup').write_text(str(NICENESS), encoding='ascii')


def main() -> None:
    """Run the node until SIGINT or SIGTERM."""
    stand_back()
    run(lambda _: TrialView())


if __name__ == '__main__':
    main()
