"""A part of a trial as a node: converts messages, runs the steps of the part, converts back."""

from __future__ import annotations

from collections import OrderedDict
from functools import partial
from typing import Any, Protocol

from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, QoSPublisherMatchedInfo
from std_msgs.msg import Header

from blocks_planning.board.geometry import Board
from blocks_planning.errors import ConfigurationError, InvalidInput
from blocks_planning.ros.runtime.diagnostics import Diagnostics, Health
from blocks_planning.ros.runtime.guarded import GuardedNode, read_message
from blocks_planning.ros.runtime.inbox import Inbox
from blocks_planning.ros.runtime.parameters import Parameter, declare
from blocks_planning.ros.runtime.peers import Peers
from blocks_planning.ros.wire.graph import NodeTopics
from blocks_planning.ros.wire.topics import STATE, TRIAL, Topic
from blocks_planning.trials.consistency import Consistency
from blocks_planning.trials.messages import Message, Remind, TrialEnded, TrialStarted, WorldState
from blocks_planning.trials.spec import TrialSpec

REMIND_PERIOD = Parameter(
    'remind_period_s',
    1.0,
    'Time without news after which unanswered messages are sent again [s].',
    (0.05, 3600.0),
)
FRAME_ID = Parameter('frame_id', 'board', 'Coordinate frame of the board, for every header.')
ACKNOWLEDGE_S = 0.3
_MOST_LEFT = 64
_OLDER_STATES = 2
"""Number of older states in a row after which the board counts as reset."""


class Part(Protocol):
    """A module such as :mod:`blocks_planning.trials.world`."""

    Memory: Any

    def step(self, memory: Any, message: Message) -> tuple[Any, tuple[Message, ...]]:
        """The step of the part for a message."""
        ...


class PartNode(GuardedNode):
    """A node that owns one part's memory.

    A message that is invalid, or contradicts its trial, is refused with a warning and counted; a
    message of a trial that is not announced yet is kept; the part handles everything else. While no
    messages arrive, the node repeats its latched messages, because a full queue may have lost them.

    Attributes:
        MOST_KNOWN: number of trials of which messages are accepted: the running one and the last
            ones.
    """

    MOST_KNOWN = 1

    def __init__(
        self,
        topics: NodeTopics,
        part: Part,
        parameters: tuple[Parameter, ...] = (),
        **options: Any,
    ) -> None:
        """Subscribe to the node's topics and advertise its publications.

        Raises:
            ConfigurationError: for a parameter that is unknown or out of its range, and for a
                frame without a name.
        """
        super().__init__(topics.name, **options)
        self.values = declare(self, (REMIND_PERIOD, FRAME_ID, *parameters))
        if not self.values['frame_id']:
            raise ConfigurationError(
                f"node {self.get_name()}: parameter frame_id must be a name, got ''"
            )
        self.trial: TrialStarted | None = None
        self._part = part
        self.memory = part.Memory()
        self._inbox = Inbox()
        self._has_news = False
        self._known: OrderedDict[str, Consistency] = OrderedDict()
        self._left: OrderedDict[str, None] = OrderedDict()
        self._is_over = False
        self._older_states = 0
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
        """Run a step of the part, and publish its messages."""
        before = self.memory
        if isinstance(message, TrialStarted):
            self.begin(message)
        if isinstance(message, TrialEnded):
            self._latched.clear()
            self._is_over |= self.trial is not None and message.trial_id == self.trial.trial_id
        said = self.advance(message)
        self._has_news |= self.memory is not before and not isinstance(message, Remind)
        for answer in said:
            self.say(answer)
        if isinstance(message, TrialStarted):
            for topic, held in self._inbox.take(message.trial_id):
                self._receive(topic, held)

    def advance(self, message: Message) -> tuple[Message, ...]:
        """Run a step of the part; return its messages."""
        said: tuple[Message, ...]
        self.memory, said = self._part.step(self.memory, message)
        return said

    def receive(self, message: Message) -> None:
        """Handle a message from the graph that is well formed and consistent with its trial."""
        if isinstance(message, WorldState):
            known = getattr(self.memory, 'state', None)
            is_older = known is not None and message.sequence < known.sequence
            self._older_states = self._older_states + 1 if is_older else 0
        self.take(message)

    def health(self) -> Health:
        """The health of the node."""
        return Health(
            'building' if self.is_busy else 'idle',
            self.trial.trial_id if self.is_busy and self.trial is not None else '',
            *self.peers.around(self.topics),
            values={'messages_refused': self.refused, **self.load()},
        )

    @property
    def is_busy(self) -> bool:
        """Whether a trial is running in this node."""
        return getattr(self.memory, 'trial', None) is not None

    def load(self) -> dict[str, object]:
        """Counts of pending and finished work, by name; see :mod:`.diagnostics`."""
        return {}

    def begin(self, trial: TrialStarted) -> None:
        """Set the running trial.

        A trial that is announced after its end runs again: its earlier messages no longer count.
        """
        if self.trial is None or self.trial.trial_id != trial.trial_id:
            self._known.setdefault(trial.trial_id, Consistency(trial.spec))
        elif self._is_over:
            self._known[trial.trial_id] = Consistency(trial.spec)
        else:
            return
        self.trial, self._is_over, self._older_states = trial, False, 0
        self._left.pop(trial.trial_id, None)
        self._known.move_to_end(trial.trial_id)
        while len(self._known) > self.MOST_KNOWN:
            self._left[self._known.popitem(last=False)[0]] = None
        while len(self._left) > _MOST_LEFT:
            self._left.popitem(last=False)

    def cares_for(self, topic: Topic, spec: TrialSpec) -> bool:
        """Whether messages of a topic matter in a trial."""
        return True

    @property
    def board(self) -> Board:
        """The board of the running trial; there must be one."""
        if self.trial is None:
            raise RuntimeError('no trial is running')
        return self.trial.spec.task.board

    def say(self, message: Message) -> None:
        """Publish a message, or :meth:`perform` a command that has no topic."""
        topic = self._said.get(type(message))
        if topic is None:
            self.perform(message)
        else:
            board = None if self.trial is None else self.trial.spec.task.board
            self.publish(topic, topic.to_ros(board, message))

    def stamped(self, message: Any) -> Any:
        """A message with the time and the frame in its header, and in those of its parts."""
        stamp = self.get_clock().now().to_msg()
        message.header = Header(stamp=stamp, frame_id=self.values['frame_id'])
        for part in getattr(message, 'proposals', ()):
            part.header = message.header
        return message

    def publish(self, topic: Topic, message: Any) -> None:
        """Stamp and publish."""
        self.stamped(message)
        if topic.latched:
            self._latched[topic] = message
        self._outlets[topic.kind].publish(message)

    def wait_until_heard(self, topic: Topic) -> None:
        """Wait for a limited time until all subscribers of a topic have received the messages."""
        self._outlets[topic.kind].wait_for_all_acked(Duration(seconds=ACKNOWLEDGE_S))

    def perform(self, message: Message) -> None:
        """Carry out a command of the part that has no topic."""
        raise NotImplementedError(f'{type(message).__name__} is not for {self.get_name()}')

    def _receive(self, topic: Topic, data: bytes) -> None:
        try:
            message = read_message(topic.ros_type, data)
            if topic is TRIAL:
                converted = topic.from_ros(None, message)
            elif (known := self._known.get(message.trial_id)) is None:
                self._hold(topic, message, data)
                return
            elif not self.cares_for(topic, known.spec):
                return
            else:
                converted = topic.from_ros(known.spec.task.board, message)
                known.check(converted)
        except InvalidInput as error:
            self.refuse_message(topic, error)
        else:
            self.receive(converted)

    def refuse_message(self, topic: Topic, error: InvalidInput) -> None:
        """Refuse a message from the graph."""
        self.refuse(f'a message on {topic.name}', error)

    def _hold(self, topic: Topic, message: Any, data: bytes) -> None:
        """Keep a message until its trial is announced.

        A message of an earlier trial is late, and would be mistaken for one of the next run of that
        trial. Only the first state is kept, as it is the same in every run.
        """
        if message.trial_id not in self._left or (topic is STATE and message.sequence == 0):
            self._inbox.hold(message.trial_id, (topic, data), len(data))

    def _on_match(self, status: QoSPublisherMatchedInfo) -> None:
        """Repeat messages that a new subscriber may have missed."""
        if status.current_count_change > 0 and self.trial is not None:
            self.take(Remind(self.trial.trial_id))

    def _remind(self) -> None:
        if self.trial is not None and not self._has_news:
            if self._older_states >= _OLDER_STATES:
                self.start_over(self.trial)
            self.take(Remind(self.trial.trial_id))
            for topic, message in list(self._latched.items()):
                if message.trial_id == self.trial.trial_id:
                    self._outlets[topic.kind].publish(message)
        self._has_news = False

    def start_over(self, trial: TrialStarted) -> None:
        """Forget the state of the trial, as if this node had just been started.

        The world publishes an older board than this node knows: the board was reset, or this node
        accepted a late message of an earlier run.
        """
        self.get_logger().warning(
            f'trial {trial.trial_id}: the board was reset; starting again from its current state'
        )
        self._older_states = 0
        self._latched = {topic: said for topic, said in self._latched.items() if topic is TRIAL}
        self._known[trial.trial_id] = Consistency(trial.spec)
        self.memory = self._part.Memory()
        self.advance(trial)
