"""The node of the page, with a peer that plays everybody else."""

from __future__ import annotations

import json
import threading
import urllib.error
import urllib.request
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from builders import CHAIR, ended, spec
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from graphs import write_script
from peers import Bench, Graph
from rclpy.node import Node
from rclpy.parameter import Parameter

from blocks_planning.ros.nodes.trial_view import TrialView
from blocks_planning.ros.runtime.diagnostics import TOPIC as DIAGNOSTICS
from blocks_planning.ros.wire.graph import TRIAL_VIEW
from blocks_planning.ros.wire.topics import OUTCOME, SEARCH_RESULT, STATE
from blocks_planning.subgoals.human import Human
from blocks_planning.subgoals.proposals import Proposal, ProposalKind
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import (
    Message,
    ProposalMade,
    SearchAnswer,
    TrialEnded,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.script import read_script
from blocks_planning.view.web.pictures import rows_of
from blocks_planning.view.web.queue import Place

SCOPED = spec(CHAIR, lam=0.2, depth=2)
BY_PERSON = replace(SCOPED, strategy=Human('P01'))
BOARD = SCOPED.task.board
SEAT = Proposal(0, 0, ProposalKind.BUILD, BOARD.rows_below(4), 1.25)
HEARS = TRIAL_VIEW._replace(listens=(*TRIAL_VIEW.listens, SEARCH_RESULT))
KINDS = tuple(topic.kind for topic in HEARS.listens)


def heard(trial: Any, *proposals: Proposal) -> list[Message]:
    """What this node hears of a trial."""
    said: list[Message] = []
    run_trial(trial, observe=said.append, proposals=proposals)
    return [message for message in said if isinstance(message, KINDS)]


class ViewBench(Bench):
    """The node of the page with its peer."""

    node: TrialView


def bench(graph: Graph, trial: Any = SCOPED, **parameters: Any) -> ViewBench:
    """The node with its peer."""
    overrides = [Parameter(key, value=value) for key, value in parameters.items()]
    node = graph.add(TrialView, parameter_overrides=overrides)
    return ViewBench(graph, HEARS, node, trial)


def tell_all(on: Bench, trial: Any) -> None:
    """Say a whole trial."""
    on.tell(*visible(trial))
    end(on, trial)
    on.graph.spin_until(lambda: on.node.memory.past)


def visible(trial: Any) -> list[Message]:
    """What the node takes note of, but the end."""
    aside = (SearchAnswer, TrialEnded)
    return [message for message in heard(trial) if not isinstance(message, aside)]


def end(on: Bench, trial: Any) -> None:
    """Say the outcome of a trial."""
    on.peer.outlets[OUTCOME].publish(OUTCOME.to_ros(None, ended(trial.trial_id, run_trial(trial))))


@pytest.fixture
def fetch(graph: Graph) -> Callable[..., tuple[int, Any]]:
    """Ask the page while the nodes spin."""

    def ask(on: ViewBench, path: str, data: Any = None) -> tuple[int, Any]:
        url = on.node.page.address.url.rstrip('/')
        headers = {'Origin': url, 'Content-Type': 'application/json'}
        body = None if data is None else json.dumps(data).encode()
        request = urllib.request.Request(url + path, body, headers)
        found: list[tuple[int, Any]] = []

        def run() -> None:
            try:
                with urllib.request.urlopen(request, timeout=20) as answer:
                    found.append((answer.status, json.loads(answer.read())))
            except urllib.error.HTTPError as error:
                with error:
                    found.append((error.code, json.loads(error.read())))

        thread = threading.Thread(target=run)
        thread.start()
        graph.spin_until(lambda: found)
        thread.join()
        return found[0]

    return ask


def posted(proposal: Proposal, trial_id: str = BY_PERSON.trial_id, **changes: Any) -> Any:
    """A proposal as the page sends it."""
    return {
        'trial_id': trial_id,
        'sequence': proposal.sequence,
        'number': proposal.number,
        'kind': proposal.kind.value,
        'region': rows_of(BOARD, proposal.region),
        'thinking_s': proposal.thinking_s,
        **changes,
    }


def test_shows_the_trial_that_it_hears(graph: Graph, fetch: Callable[..., Any]) -> None:
    on = bench(graph)
    tell_all(on, SCOPED)
    assert on.node.memory.scene.record == run_trial(SCOPED)
    status, (summary,) = fetch(on, '/trials')
    assert status == 200
    assert (summary['status'], summary['blocks']) == ('success', run_trial(SCOPED).blocks)


def test_says_what_a_person_proposes(graph: Graph, fetch: Callable[..., Any]) -> None:
    on = bench(graph, BY_PERSON)
    messages = heard(BY_PERSON, SEAT)
    on.tell(*messages[:2])
    assert fetch(on, '/proposal', posted(SEAT)) == (200, {'taken': True})
    assert on.hear(1, ProposalMade) == [ProposalMade(BY_PERSON.trial_id, SEAT)]
    status, refused = fetch(on, '/proposal', posted(SEAT))
    assert (status, refused['code']) == (409, 'stale')
    again = replace(SEAT, number=1)
    status, refused = fetch(on, '/proposal', posted(again))
    assert (status, refused['code']) == (409, 'waiting')


@pytest.mark.parametrize(
    ('changes', 'status', 'code'),
    [
        ({'region': ['....'] * 6}, 422, 'empty'),
        ({'region': [*['....'] * 5, '.##.']}, 422, 'outside'),
        ({'trial_id': 'another'}, 409, 'stale'),
        ({'kind': 'burn'}, 400, 'malformed'),
    ],
)
def test_does_not_say_what_can_not_be_taken(
    changes: Any, status: int, code: str, graph: Graph, fetch: Callable[..., Any]
) -> None:
    on = bench(graph, BY_PERSON)
    on.tell(*heard(BY_PERSON, SEAT)[:2])
    answered, said = fetch(on, '/proposal', posted(SEAT, **changes))
    assert (answered, said['code']) == (status, code)
    assert fetch(on, '/proposal', posted(SEAT))[0] == 200
    assert on.hear(1, ProposalMade) == [ProposalMade(BY_PERSON.trial_id, SEAT)]


def test_before_a_trial_nothing_is_taken(graph: Graph, fetch: Callable[..., Any]) -> None:
    on = bench(graph)
    status, said = fetch(on, '/proposal', posted(SEAT))
    assert (status, said['code']) == (409, 'stale')


def test_hears_what_somebody_else_proposes(graph: Graph) -> None:
    """Such as one who types at a terminal."""
    on = bench(graph, BY_PERSON)
    on.tell(*heard(BY_PERSON, SEAT)[:2])
    on.peer.say(ProposalMade(BY_PERSON.trial_id, SEAT))
    graph.spin_until(lambda: on.node.memory.proposals)
    assert on.node.memory.proposals == (SEAT,)


def test_news_of_the_trial_before_are_welcome(graph: Graph) -> None:
    """Topics are not ordered among each other."""
    on = bench(graph)
    other = replace(SCOPED, seed=1)
    messages = visible(SCOPED)
    late = [m for m in messages if isinstance(m, WorldState)][-1]
    messages.remove(late)
    on.tell(*messages, TrialStarted(other.trial_id, other))
    on.peer.say(late)
    end(on, SCOPED)
    graph.spin_until(lambda: on.node.memory.past[0].scene.record == run_trial(SCOPED))
    assert on.node.memory.trial_id == other.trial_id
    assert len(on.node.memory.past) == 1


def test_refuses_what_can_not_be(graph: Graph) -> None:
    on = bench(graph, BY_PERSON)
    on.tell(*heard(BY_PERSON, SEAT)[:2])
    before = on.node.memory
    on.fence(STATE)
    on.fence(SEARCH_RESULT)
    assert on.node.refused >= 2
    assert on.node.memory == before


def test_shows_how_the_nodes_of_its_graph_are(graph: Graph) -> None:
    on = bench(graph)
    teller = graph.add(Teller)
    graph.spin_until(teller.outlet.get_subscription_count)
    for name in ('/elsewhere/world', f'{graph.namespace}/world'):
        status = DiagnosticStatus(level=DiagnosticStatus.WARN, name=name, message='slow')
        status.values = [KeyValue(key='load', value='0.5')]
        teller.outlet.publish(DiagnosticArray(status=[status]))
    graph.spin_until(lambda: on.node._health)
    (node,) = on.node._health.values()
    assert (node.name, node.level, node.message) == ('world', 'warning', 'slow')
    assert node.values == {'load': '0.5'}
    assert on.node._mailbox.seen.health == on.node._health


def test_news_of_how_a_node_is_that_cannot_be_read_is_refused(graph: Graph) -> None:
    on = bench(graph)
    teller = graph.add(Teller)
    graph.spin_until(teller.outlet.get_subscription_count)
    teller.outlet.publish(bytes.fromhex('00010000ffff'))
    graph.spin_until(lambda: on.node.refused == 1)
    assert on.node._health == {}


class Teller(Node):
    """A node that says how nodes are."""

    def __init__(self, **options: Any) -> None:
        super().__init__('teller', **options)
        self.outlet = self.create_publisher(DiagnosticArray, DIAGNOSTICS, 10)


@pytest.mark.parametrize(('strategy', 'hears'), [('none', 0), ('human', 1)])
def test_answers_are_heard_if_a_person_may_wait_for_them(
    strategy: str, hears: int, graph: Graph, tmp_path: Path
) -> None:
    script = write_script(tmp_path, strategies=[{'name': strategy}])
    parameters = [Parameter('script', value=str(script))]
    node = graph.add(TrialView, parameter_overrides=parameters)
    assert node.count_subscribers(node.resolve_topic_name(SEARCH_RESULT.name)) == hears


def test_counts_the_trials_of_its_script(graph: Graph, tmp_path: Path) -> None:
    script = write_script(tmp_path, seeds=3, strategies=[{'name': 'human'}])
    specs = read_script(script)
    on = bench(graph, specs[1], script=str(script))
    assert seen_place(on) == (None, 3, tuple(specs))
    on.tell(TrialStarted(specs[1].trial_id, specs[1]))
    assert seen_place(on) == (1, 3, (specs[2],))


def test_counts_the_trials_of_the_person_who_is_named(graph: Graph, tmp_path: Path) -> None:
    """They have other ids than those of the script alone."""
    script = write_script(tmp_path, strategies=[{'name': 'human'}])
    (trial,) = read_script(script, 'P09')
    on = bench(graph, trial, script=str(script), participant='P09')
    on.tell(TrialStarted(trial.trial_id, trial))
    assert seen_place(on) == (0, 1, ())


def seen_place(on: ViewBench) -> Place:
    """What the page is shown of the script."""
    return on.node._mailbox.seen.place


def test_answers_that_no_person_waits_for_are_left_alone(graph: Graph) -> None:
    """They are many, and nothing that is shown depends on them."""
    on = bench(graph)
    on.tell(*heard(SCOPED)[:2])
    answers = [m for m in heard(SCOPED) if isinstance(m, SearchAnswer)]
    for answer in answers:
        on.peer.say(answer)
    on.fence(STATE)
    assert on.node.memory.answers == {}
