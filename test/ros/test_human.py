"""A person scopes through the graph: here a peer that proposes what a scripted person would."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest
from graphs import bring_up, record_lines, run_graph, write_script
from peers import Bench, Graph, Peer
from persons import BUILD, WITHDRAWN, Person, human_spec, rows_of

from blocks_planning.ros.bagging.bags import trials_of
from blocks_planning.ros.nodes import subgoal_selector
from blocks_planning.ros.wire.graph import SUBGOAL_SELECTOR
from blocks_planning.ros.wire.topics import OUTCOME, PROPOSAL, SEARCH_RESULT, STATE, SUBGOAL, TRIAL
from blocks_planning.subgoals.proposals import Proposal
from blocks_planning.trials.execution import SubgoalChosen, history
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import (
    Message,
    ProposalMade,
    SearchRequest,
    TrialEnded,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.reading import read_records
from blocks_planning.trials.script import read_script
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.verify import contradictions

SPEC = human_spec('#..#/#..#/####/####/#..#/#..#', depth=2)


class Proposer(Peer):
    """Says the next word of a person when it is the person's turn: when nothing else can go on."""

    def __init__(self, spec: Any, **options: Any) -> None:
        super().__init__(
            spec,
            (PROPOSAL,),
            (TRIAL, STATE, SUBGOAL, SEARCH_RESULT, OUTCOME),
            'proposer',
            **options,
        )
        self.person: Person | None = None
        self._words: Any = None
        self._trial_id = ''
        self._is_waiting = False
        # The answer may have been said before this node was known to the searcher.
        self.create_timer(1.0, self._repeat)

    def _repeat(self) -> None:
        """Say again what nobody answers."""
        if self._is_waiting and self.person is not None:
            self.say(ProposalMade(self._trial_id, self.person.repeat()))

    def _hear(self, topic: Any, message: Any) -> None:
        super()._hear(topic, message)
        heard = self.heard[-1]
        if isinstance(heard, TrialStarted):
            if heard.trial_id == self._trial_id:
                return  # announced again
            self._trial_id = heard.trial_id
            self.person = Person(heard.spec, seed=heard.spec.seed)
            self._words = iter(self.person)
            # Topics are not ordered: what belongs to the trial may have come before it.
            for early in [m for m in self.heard[:-1] if m.trial_id == self._trial_id]:
                self.person.observe(early)
                self._speak(early)
        elif self.person is not None and heard.trial_id == self._trial_id:
            self.person.observe(heard)
            self._speak(heard)

    def _speak(self, heard: Message) -> None:
        """In a state that no subgoal leads on from, or after an answer that it can't be built."""
        assert self.person is not None
        self._is_waiting = False
        chosen = [m for m in self.heard if isinstance(m, SubgoalChosen)]
        chosen = [m for m in chosen if m.trial_id == self._trial_id]
        state = self.person.state
        if state is None or isinstance(heard, (SubgoalChosen, TrialEnded)):
            return
        if state.status.value != 'building' or (
            chosen and is_under_way(self.person.spec, chosen[-1], state)
        ):
            return
        is_answer = not isinstance(heard, WorldState)
        if is_answer and heard.result.solved:  # type: ignore[union-attr]
            return
        while True:
            word = next(self._words)
            self.say(ProposalMade(self._trial_id, word))
            if word.kind is not WITHDRAWN:
                self._is_waiting = True
                return


def is_under_way(spec: TrialSpec, chosen: SubgoalChosen, state: WorldState) -> bool:
    """Whether the subgoal leads on from a state, or begins after it."""
    if chosen.sequence > state.sequence:
        return True
    seen = history(spec.task.board, state.observations)
    return chosen.progress(spec, seen).is_open


def test_whole_graph_with_a_person(graph: Graph, tmp_path: Path) -> None:
    """What the person said is in the records and in the bag, and gives the same in process."""
    strategies = [{'name': 'human', 'costs': 'hidden'}]
    script, out = write_script(tmp_path, seeds=3, strategies=strategies), tmp_path / 'out'
    specs = read_script(script, 'P07')
    proposer = graph.add(Proposer, specs[0], namespace='')
    arguments = ['--out', out, '--bag', tmp_path / 'bag', '--participant', 'P07']
    with bring_up(script, *arguments, '--domain', os.environ['ROS_DOMAIN_ID']) as process:
        graph.spin_until(lambda: process.poll() is not None, deadline_s=60)
    assert process.returncode in (0, 1)
    records = read_records(out / 'trials.jsonl')
    assert [record.spec for record in records] == specs
    assert proposer.person is not None
    used = records[-1].proposals  # the peer may say a word too many: topics are not ordered
    assert [word for word in proposer.person.said if word in used] == list(used) != []
    for record, line in zip(records, record_lines(out), strict=True):
        assert list(contradictions(record)) == []
        assert run_trial(record.spec, proposals=record.proposals).to_line() == line
    recorded = list(trials_of(tmp_path / 'bag'))
    assert [trial.record for trial in recorded] == records
    assert not [c for trial in recorded for c in trial.contradictions()]


def test_selector_that_comes_late_hears_all_that_was_said(graph: Graph) -> None:
    said = rows_of(SPEC, 2, 4, 6)
    heard: list[Message] = []
    run_trial(SPEC, observe=heard.append, proposals=said)
    states = [m for m in heard if isinstance(m, WorldState)]
    middle = next(state for state in states if state.sequence == said[1].sequence)
    peer = graph.add(Peer, SPEC, SUBGOAL_SELECTOR.listens, SUBGOAL_SELECTOR.says)
    for message in (heard[0], middle, *(ProposalMade(SPEC.trial_id, word) for word in said[:2])):
        peer.say(message)
    node = graph.add(subgoal_selector.make_node)
    graph.spin_until(lambda: len(node.memory.proposals) == 2)
    graph.spin_until(lambda: peer.only(SearchRequest))
    assert peer.only(SearchRequest)[0].queries[0].built == 0


@pytest.mark.parametrize(
    ('proposal', 'said'),
    [
        (Proposal(0, 1, BUILD, SPEC.task.rows(1), 1.0), 'number: expected 0, got 1'),
        (Proposal(0, 0, BUILD, 0, 1.0), 'region: expected a target cell that is still empty'),
    ],
)
def test_proposal_that_is_not_taken_is_refused_with_a_reason(
    proposal: Proposal, said: str, graph: Graph, capfd: pytest.CaptureFixture[str]
) -> None:
    on = Bench(graph, SUBGOAL_SELECTOR, graph.add(subgoal_selector.make_node), SPEC)
    run_trial(
        SPEC, observe=lambda m: on.tell(m) if isinstance(m, (TrialStarted, WorldState)) else None
    )
    capfd.readouterr()
    memory = on.node.memory
    refused = on.node.refused
    on.peer.say(ProposalMade(SPEC.trial_id, proposal))
    graph.spin_until(lambda: on.node.refused == refused + 1)
    assert on.node.memory == memory


def test_participant_of_a_script_without_people_is_refused(tmp_path: Path) -> None:
    done = run_graph(write_script(tmp_path), '--out', tmp_path / 'out', '--participant', 'P07')
    assert (done.returncode, done.stdout) == (2, '')
    assert (
        "participant 'P07' was given, but no strategy in the script asks a person" in done.stderr
    )
