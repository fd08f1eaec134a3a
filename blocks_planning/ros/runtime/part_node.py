"""A part of a trial as a node: convert, let the part step, convert back."""

from __future__ import annotations

from collections import OrderedDict
from functools import partial
from typing import Any, Protocol

from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, QoSPublisherMatchedInfo

from blocks_planning.board.geometry import Board
from blocks_planning.errors import InvalidInput
from blocks_planning.ros.runtime.diagnostics import Diagnostics, Health
from blocks_planning.ros.runtime.guarded import GuardedNode, read_message
from blocks_planning.ros.runtime.inbox import Inbox
from blocks_planning.ros.runtime.parameters import Parameter, declare
from blocks_planning.ros.runtime.peers import Peers
from blocks_planning.ros.wire.graph import NodeTopics
from blocks_planning.ros.wire.topics import TRIAL, Topic
from blocks_planning.trials.consistency import Consistency
from blocks_planning.trials.messages import Message, Remind, TrialEnded, TrialStarted
from blocks_planning.trials.spec import TrialSpec

REMIND_PERIOD = Parameter(
    'remind_period_s',
    1.0,
    'After so long without news, say again what nobody has answered [s].',
    (0.05, 3600.0),
)
ACKNOWLEDGE_S = 0.3


class Part(Protocol):
    """A module such as :mod:`blocks_planning.trials.world`."""

    Memory: Any

    def step(self, memory: Any, message: Message) -> tuple[Any, tuple[Message, ...]]:
        """What the part does with a message."""
        ...


class PartNode(GuardedNode):
    """A node that owns one part's memory.

    A message that can't be, or does not fit its trial, is refused with a warning and counted; one
    of a trial that is not known yet waits; everything else is for the part to judge. What the
    node has latched is said again while there is no news: a queue that was flooded has lost it.

    Attributes:
        MOST_KNOWN: trials that messages are taken of, the one that runs and those just before.
    """

    MOST_KNOWN = 1

    def __init__(
        self,
        topics: NodeTopics,
        part: Part,
        parameters: tuple[Parameter, ...] = (),
        **options: Any,
    ) -> None:
        """Subscribe to the node's topics and advertise what it says.

        Raises:
            ConfigurationError: for a parameter that is unknown or out of its range.
        """
        super().__init__(topics.name, **options)
        self.values = declare(self, (REMIND_PERIOD, *parameters))
        self.trial: TrialStarted | None = None
        self._part = part
        self.memory = part.Memory()
        self._inbox = Inbox()
        self._has_news = False
        self._known: OrderedDict[str, Consistency] = OrderedDict()
        self._latched: dict[Topic, Any] = {}
        self._said = {topic.kind: topic for topic in topics.says}
        events = PublisherEventCallbacks(matched=self._on_match)
        self._outlets = {
            topic.kind: self.create_publisher(
                topic.ros_type, topic.name, topic.publisher_qos, event_callbacks=events
            )
            for topic in topics.says
        }
        for topic in topics.listens:
            self.listen(topic)
        self.create_timer(self.values['remind_period_s'], self._remind, clock=self.steady)
        self.topics = topics
        self.peers = Peers(self)
        self._diagnostics = Diagnostics(self, self.health)

    def listen(self, topic: Topic) -> None:
        """Subscribe to a topic."""
        self.take_bytes(topic, partial(self._receive, topic))

    def take(self, message: Message) -> None:
        """Let the part step, and say what it says."""
        before = self.memory
        if isinstance(message, TrialStarted):
            self.begin(message)
        if isinstance(message, TrialEnded):
            self._latched.clear()
        said = self.advance(message)
        self._has_news |= self.memory is not before and not isinstance(message, Remind)
        for answer in said:
            self.say(answer)
        if isinstance(message, TrialStarted):
            for topic, held in self._inbox.take(message.trial_id):
                self._receive(topic, held)

    def advance(self, message: Message) -> tuple[Message, ...]:
        """Let the part step; return what is to be said."""
        said: tuple[Message, ...]
        self.memory, said = self._part.step(self.memory, message)
        return said

    def receive(self, message: Message) -> None:
        """A message from the graph that is as it must be."""
        self.take(message)

    def health(self) -> Health:
        """How the node is."""
        return Health(
            'building' if self.is_busy else 'idle',
            self.trial.trial_id if self.is_busy and self.trial is not None else '',
            *self.peers.around(self.topics),
            values={'messages_refused': self.refused, **self.load()},
        )

    @property
    def is_busy(self) -> bool:
        """Whether a trial runs here."""
        return getattr(self.memory, 'trial', None) is not None

    def load(self) -> dict[str, object]:
        """What the node has to do, and has done, by name; see :mod:`.diagnostics`."""
        return {}

    def begin(self, trial: TrialStarted) -> None:
        """Take note of the trial that runs."""
        if self.trial is None or self.trial.trial_id != trial.trial_id:
            self.trial = trial
            self._known.setdefault(trial.trial_id, Consistency(trial.spec))
            self._known.move_to_end(trial.trial_id)
            while len(self._known) > self.MOST_KNOWN:
                self._known.popitem(last=False)

    def cares_for(self, topic: Topic, spec: TrialSpec) -> bool:
        """Whether messages of a topic matter in a trial."""
        return True

    @property
    def board(self) -> Board:
        """The board of the trial that runs; there must be one."""
        if self.trial is None:
            raise RuntimeError('no trial runs')
        return self.trial.spec.task.board

    def say(self, message: Message) -> None:
        """Publish a message, or :meth:`perform` what no topic carries."""
        topic = self._said.get(type(message))
        if topic is None:
            self.perform(message)
        elif topic is TRIAL:
            self.publish(topic, topic.to_ros(message))
        else:
            self.publish(topic, topic.to_ros(self.board, message))

    def publish(self, topic: Topic, message: Any) -> None:
        """Stamp and publish."""
        message.header.stamp = self.get_clock().now().to_msg()
        if topic.latched:
            self._latched[topic] = message
        self._outlets[topic.kind].publish(message)

    def wait_until_heard(self, topic: Topic) -> None:
        """Wait, not long, until all listeners of a topic have got what was published."""
        self._outlets[topic.kind].wait_for_all_acked(Duration(seconds=ACKNOWLEDGE_S))

    def perform(self, message: Message) -> None:
        """Do what the part wants done that is no message."""
        raise NotImplementedError(f'{type(message).__name__} is not for {self.get_name()}')

    def _receive(self, topic: Topic, data: bytes) -> None:
        try:
            message = read_message(topic.ros_type, data)
            if topic is TRIAL:
                converted = topic.from_ros(message)
            elif (known := self._known.get(message.trial_id)) is None:
                self._inbox.hold(message.trial_id, (topic, data), len(data))
                return
            elif not self.cares_for(topic, known.spec):
                return
            else:
                converted = _convert(topic, known.spec.task.board, message)
                known.check(converted)
        except InvalidInput as error:
            self.refuse(f'a message on {topic.name}', error)
        else:
            self.receive(converted)

    def _on_match(self, status: QoSPublisherMatchedInfo) -> None:
        """A listener came: it may have missed what was asked before."""
        if status.current_count_change > 0 and self.trial is not None:
            self.take(Remind(self.trial.trial_id))

    def _remind(self) -> None:
        if self.trial is not None and not self._has_news:
            self.take(Remind(self.trial.trial_id))
            for topic, message in list(self._latched.items()):
                if message.trial_id == self.trial.trial_id:
                    self._outlets[topic.kind].publish(message)
        self._has_news = False


def _convert(topic: Topic, board: Board, message: Any) -> Message:
    """What a ROS message of a trial on a board says."""
    converted: Message
    converted = topic.from_ros(board, message) if topic.needs_board else topic.from_ros(message)
    return converted
