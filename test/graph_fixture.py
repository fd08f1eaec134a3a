"""Nodes of a test are in a graph of their own; for the ``conftest`` of folders that have nodes."""

from __future__ import annotations

from collections.abc import Iterator

import peers
import pytest
from peers import Graph


def pytest_sessionfinish(exitstatus: int) -> None:
    """A process that had nodes ends with what the session says."""
    peers.exit_status = int(exitstatus)


@pytest.fixture
def graph() -> Iterator[Graph]:
    """An empty graph, taken down after the test."""
    made = Graph()
    yield made
    made.close()
