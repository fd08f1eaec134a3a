"""How long a trial waits for its world, and how often an order is given again.

A world owes a trial its first state, and a later state for each order. Until then it may say ``in
progress`` as long as it lasts; its silence is bounded. An order that it answers with ``try again``
or ``impossible`` is given again; that is bounded too, and so is the number of observations.
"""

from __future__ import annotations

from blocks_planning.trials.messages import (
    Message,
    PlaceBlock,
    PlacementCode,
    PlacementOutcome,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.world import TOO_MANY
from blocks_planning.worlds.observation import MAX_OBSERVATIONS

_NOT_DONE = (PlacementCode.TRY_AGAIN, PlacementCode.IMPOSSIBLE)
_SHOWN = 200


class Patience:
    """What a world owes a trial, since when. All times are those of one steady clock [s]."""

    def __init__(self, timeout_s: float, retries: int) -> None:
        """No trial yet.

        Args:
            timeout_s: how long the world may be silent [s].
            retries: how often an order is given again; also how often the board may be set back.
        """
        self._timeout_s = timeout_s
        self._retries = retries
        self._trial_id = self._refused = ''
        self._set_backs = 0
        self._since: float | None = None
        self._expect(None)

    def hear(self, message: Message, now_s: float) -> str:
        """Take note of a message; return why the trial cannot go on, or ''."""
        if isinstance(message, TrialStarted):
            self._trial_id, self._set_backs = message.trial_id, 0
            self._expect(now_s)
        if message.trial_id != self._trial_id:
            return ''
        match message:
            case WorldState(sequence=sequence) if sequence > self._sequence:
                self._expect(None, sequence)
                return TOO_MANY if sequence >= MAX_OBSERVATIONS else ''
            case PlaceBlock(sequence=sequence) if sequence == self._sequence:
                self._order(message, now_s)
            case PlacementOutcome(sequence=at) if at == max(self._sequence, 0):
                return self._note(message, now_s)
        return ''

    def refused(self, reason: str) -> None:
        """Take note that a state was refused, and why."""
        self._refused = reason

    def excuse(self, now_s: float) -> None:
        """Wait from now on again: a node is missing, and another bound holds for that."""
        if self._since is not None:
            self._since = now_s

    def set_back(self, now_s: float) -> str:
        """Take note that the world shows an older board; return why the trial cannot go on."""
        self._set_backs += 1
        self._expect(now_s)
        if self._set_backs <= self._retries:
            return ''
        return f'the world went back to an earlier state {self._set_backs} times'

    def overdue(self, now_s: float) -> str:
        """That the world has been silent for too long, as a sentence; or ''."""
        if self._since is None or now_s - self._since < self._timeout_s:
            return ''
        waited = f'the world has been silent for {now_s - self._since:.1f} s after {self._after}'
        if not self._refused:
            return waited
        return f'{waited}; its last state was refused: {self._refused[:_SHOWN]}'

    def _expect(self, since_s: float | None, sequence: int = -1) -> None:
        """Start anew after a state, -1 for none; what comes next is due since then, or not yet."""
        self._sequence = sequence
        self._since = since_s
        self._after = 'the trial was announced'
        self._tries = 0
        self._is_open = False
        self._refused = ''

    def _order(self, order: PlaceBlock, now_s: float) -> None:
        """A later state is due; an order that is given again while it is open changes nothing."""
        self._is_open = True
        if self._since is None:
            self._since = now_s
        block, column = order.placement
        self._after = f'block {block} was ordered in column {column}'

    def _note(self, outcome: PlacementOutcome, now_s: float) -> str:
        if outcome.code is PlacementCode.IN_PROGRESS:
            self.excuse(now_s)
        if outcome.code not in _NOT_DONE or not self._is_open:
            return ''
        self._is_open, self._since = False, None
        self._tries += 1
        if self._tries <= self._retries:
            return ''
        times = f'{self._tries} times' if self._tries > 1 else 'once'
        return f'{self._after} {times}; the last answer: {outcome.sentence}'
