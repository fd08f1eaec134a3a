"""A node that follows the graph and folds its messages into a scene."""

from __future__ import annotations

from typing import Any

from blocks_planning.ros.runtime.parameters import Parameter
from blocks_planning.ros.runtime.part_node import PartNode
from blocks_planning.ros.wire.graph import WATCHER, NodeTopics
from blocks_planning.trials.messages import Message, TrialStarted
from blocks_planning.view.scene import Scene, scene_after


class _Watching:
    """A part that sends nothing; its memory is a scene, or None before the first trial."""

    Memory: Any = staticmethod(lambda: None)

    def step(
        self, memory: Scene | None, message: Message
    ) -> tuple[Scene | None, tuple[Message, ...]]:
        """Update the scene."""
        if memory is not None:
            return scene_after(memory, message), ()
        return (Scene(message) if isinstance(message, TrialStarted) else None), ()


class Watcher(PartNode):
    """A node that publishes nothing; ``scene`` is the current scene."""

    def __init__(
        self,
        topics: NodeTopics = WATCHER,
        parameters: tuple[Parameter, ...] = (),
        **options: Any,
    ) -> None:
        """See :class:`PartNode`."""
        super().__init__(topics, _Watching(), parameters, **options)

    @property
    def scene(self) -> Scene | None:
        """The running trial, or the last one."""
        scene: Scene | None = self.memory
        return scene
