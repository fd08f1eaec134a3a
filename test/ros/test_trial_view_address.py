"""Where the node of the page serves it, and to whom."""

from __future__ import annotations

import asyncio

import pytest
from peers import Graph
from rclpy.parameter import Parameter

from blocks_planning.errors import ConfigurationError
from blocks_planning.ros.nodes.trial_view import TOKEN_VARIABLE, TrialView
from blocks_planning.ros.runtime.reserving import ReservedPort


def test_token_is_that_of_the_environment(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """In the arguments of a process it could be read by everybody."""
    monkeypatch.setenv(TOKEN_VARIABLE, 'a-token_of-24-characters')
    node = graph.add(TrialView)
    assert node.page.address.url.endswith('/?token=a-token_of-24-characters')


def test_off_this_machine_there_is_a_token(graph: Graph) -> None:
    node = graph.add(TrialView, parameter_overrides=[Parameter('host', value='0.0.0.0')])
    assert len(node.page.address.token) >= 32


def test_a_port_that_is_taken_is_refused(graph: Graph) -> None:
    port = graph.add(TrialView).page.address.port
    with pytest.raises(ConfigurationError, match=f'cannot be served at 127.0.0.1:{port}'):
        graph.add(TrialView, parameter_overrides=[Parameter('port', value=port)])


def test_a_reserved_port_is_for_who_is_told() -> None:
    """Nobody else gets it, who listens may come and go, and never two at once."""
    reserved = ReservedPort('127.0.0.1')

    async def listen() -> asyncio.AbstractServer:
        return await asyncio.start_server(lambda *_: None, '127.0.0.1', reserved.number)

    async def come_and_go() -> None:
        for _ in range(2):
            server = await listen()
            with pytest.raises(OSError, match='in use'):
                await listen()
            with pytest.raises(ConfigurationError, match='cannot be served'):
                ReservedPort('127.0.0.1', reserved.number)
            server.close()
            await server.wait_closed()

    asyncio.run(come_and_go())
    reserved.release()
