"""What is said to recorders, and who says it."""

from __future__ import annotations

import pytest
from bag_builders import Said, trial_said
from builders import CHAIR, SQUARE, spec
from peers import Graph
from recorders import Peer


@pytest.fixture
def peer(graph: Graph) -> Peer:
    return Peer(graph)


@pytest.fixture(scope='module')
def said() -> list[Said]:
    return [one for tower in (SQUARE, CHAIR) for one in trial_said(spec(tower))[1]]
