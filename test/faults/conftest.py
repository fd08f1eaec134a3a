"""Nodes of a test are in a graph of their own."""

from graph_fixture import graph, pytest_sessionfinish  # noqa: F401
