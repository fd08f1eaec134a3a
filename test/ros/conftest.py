"""Nodes of a test are in a graph of their own."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from graph_fixture import graph, pytest_sessionfinish  # noqa: F401
from peers import Graph


@pytest.fixture
def spin_until(graph: Graph) -> Callable[..., None]:  # noqa: F811
    """Spin the nodes of the graph until a condition holds."""
    return graph.spin_until
