"""The names of the package itself, and the frames of records."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

import pytest
from builders import ARCH, CHAIR, record, spec

import blocks_planning
from blocks_planning.experiments.frames import frames
from blocks_planning.subgoals.proposals import Proposal, ProposalKind
from blocks_planning.trials.following import decide, run_trials
from blocks_planning.trials.local import run_trial


@pytest.mark.parametrize('name', blocks_planning.__all__)
def test_every_name_can_be_used_and_is_explained(name: str) -> None:
    assert getattr(blocks_planning, name).__doc__
    assert name in dir(blocks_planning)
    assert f'``{name}``' in (blocks_planning.__doc__ or '')


def test_other_names_are_unknown() -> None:
    with pytest.raises(AttributeError, match="has no attribute 'solve_everything'"):
        blocks_planning.solve_everything  # noqa: B018


def test_import_brings_nothing_with_it() -> None:
    code = 'import sys, blocks_planning; print(sorted(n for n in sys.modules if "blocks_p" in n))'
    done = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, check=True)
    assert done.stdout == "['blocks_planning']\n"


def test_trials_that_share_solves_have_the_records_of_single_ones() -> None:
    specs = [
        spec(rows, library=library, strategy=strategy, seed=seed, depth=2)
        for rows, library in ((ARCH, '1x2,2x1'), (ARCH, '1x2,2x1,2x2'), (CHAIR, '1x2,2x1'))
        for strategy in ('none', 'scoping', 'full')
        for seed in (1, 2)
    ]
    assert run_trials(specs) == [run_trial(one) for one in specs]


def test_first_decision_is_that_of_the_trial() -> None:
    one = spec(CHAIR, seed=3)
    assert decide(one) == run_trial(one).decisions[0].decision
    later = replace(one, built=run_trial(one).placements[:1])
    assert decide(later) == run_trial(later).decisions[0].decision
    assert decide(later).built != 0


def test_frames_have_every_candidate_and_the_choice() -> None:
    records = [
        record(CHAIR),
        record(CHAIR, choice='softmax'),
        record(ARCH, strategy='none', seed=1),
    ]
    assert records[1].decisions[0].decision.candidates[0].probability is not None
    found = frames(records, 'small').candidates
    decisions = [
        (one.spec.trial_id, number, entry.decision)
        for one in records
        for number, entry in enumerate(one.decisions)
    ]
    assert len(found) == sum(len(decision.candidates) for _, _, decision in decisions)
    for trial_id, number, decision in decisions:
        rows = found[(found['trial_id'] == trial_id) & (found['decision'] == number)]
        assert list(rows['planning_cost']) == [c.planning_cost for c in decision.candidates]
        assert list(rows['probability'].dropna()) == [
            c.probability for c in decision.candidates if c.probability is not None
        ]
        assert list(rows['status']) == [c.status.value for c in decision.candidates]
        assert rows['regions'].iloc[0] == [str(r.label) for r in decision.candidates[0].regions]
        assert rows[rows['chosen']]['candidate'].tolist() == [decision.chosen]


def test_frames_of_nothing_have_their_columns() -> None:
    found = frames([])
    assert all(len(frame) == 0 and len(frame.columns) > 5 for frame in found)


def test_frames_have_every_proposal_of_a_person() -> None:
    one = spec(CHAIR, strategy='human')
    proposals = [
        Proposal(0, 0, ProposalKind.WITHDRAWN, 1, 0.5),
        Proposal(0, 1, ProposalKind.GIVE_UP, 0, 1.25),
    ]
    found = frames([run_trial(one, proposals=proposals)]).proposals
    assert found['kind'].tolist() == ['withdrawn', 'give_up']
    assert found['thinking_s'].tolist() == [0.5, 1.25]
    assert found['region'].tolist() == ['0x1', '0x0']
