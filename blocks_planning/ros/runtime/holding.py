"""The services ``pause``, ``resume`` and ``step``: when orders may be given."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from std_srvs.srv import Trigger

from blocks_planning.ros.runtime.guarded import GuardedNode


class Holding:
    """Up to which state orders may be given. A pause outlasts the trial.

    Attributes:
        until: the first sequence in which no order may be given; None: there is none.
    """

    def __init__(self) -> None:
        """Nothing is paused."""
        self.until: int | None = None

    def begin(self) -> None:
        """A trial begins, or starts over."""
        if self.until is not None:
            self.until = 0

    def pause(self, sequence: int) -> str:
        """Give no order any more, from a state on; return what was done."""
        self.until = sequence
        return 'paused; an order that was given is carried out'

    def resume(self, sequence: int) -> str:
        """Give orders again; return what was done."""
        was_held, self.until = self.until is not None, None
        return 'resumed' if was_held else 'was not paused'

    def step(self, sequence: int) -> str:
        """Give one more order; return what was done, or '' if that is not possible."""
        if self.until is None:
            return ''
        self.until = max(self.until, sequence) + 1
        return f'one order in state {self.until - 1}'


class HoldServices:
    """The services of a node that gives them to a :class:`Holding`."""

    def __init__(
        self,
        node: GuardedNode,
        holding: Holding,
        sequence: Callable[[], int],
        tell: Callable[[], None],
    ) -> None:
        """Offer the services.

        Args:
            node: that offers them.
            holding: what they change.
            sequence: of the latest state.
            tell: is called after each change.
        """

        def offer(name: str, change: Callable[[int], str]) -> Any:
            def answer(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
                done = change(sequence())
                tell()
                response.success = bool(done)
                response.message = done or f'{name} needs a pause: call the service pause first'
                return response

            return node.create_service(Trigger, name, answer)

        for name in ('pause', 'resume', 'step'):
            offer(name, getattr(holding, name))
