"""Watching the graph: what it shows at the moment, as a scene."""

from __future__ import annotations

from typing import Any

from blocks_planning.ros.runtime.parameters import Parameter
from blocks_planning.ros.runtime.part_node import PartNode
from blocks_planning.ros.wire.graph import WATCHER, NodeTopics
from blocks_planning.trials.messages import Message, TrialStarted
from blocks_planning.view.scene import Scene, scene_after


class _Watching:
    """A part that only looks; its memory is a scene, or None before the first trial."""

    Memory: Any = staticmethod(lambda: None)

    def step(
        self, memory: Scene | None, message: Message
    ) -> tuple[Scene | None, tuple[Message, ...]]:
        """Look."""
        if memory is not None:
            return scene_after(memory, message), ()
        return (Scene(message) if isinstance(message, TrialStarted) else None), ()


class Watcher(PartNode):
    """A node that only listens; ``scene`` is what there is to see."""

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
        """The trial that runs, or was the last to run."""
        scene: Scene | None = self.memory
        return scene
