"""The tables of trials, and of what people proposed."""

from __future__ import annotations

import io
from dataclasses import replace

import pytest
from builders import ARCH, CHAIR, SQUARE, record
from persons import human_record
from rich.console import Console

from blocks_planning.subgoals.proposals import ProposalKind
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view.tables import print_proposals, print_summary


def printed(*records: TrialRecord, width: int = 80) -> list[list[str]]:
    """The lines of the table that hold words, as words."""
    out = io.StringIO()
    print_proposals(records, Console(file=out, width=width))
    lines = out.getvalue().splitlines()
    assert all(len(line) <= width for line in lines)
    return [line.split() for line in lines if line.strip(' ─')]


@pytest.mark.parametrize('seed', range(6))
def test_counts_are_those_of_the_proposals(seed: int) -> None:
    done = human_record(CHAIR, seed)
    kinds = [proposal.kind for proposal in done.proposals]
    seconds = [proposal.thinking_s for proposal in done.proposals]
    title, head, row = printed(done)
    assert title[0] == 'Proposals;'
    assert head[:5] == ['participant', 'stimulus', 'proposed', 'built', 'withdrawn']
    assert head[5:] == ['thinking', 'each']
    assert row == [
        *('P01', 'small'),
        str(sum(kind is ProposalKind.BUILD for kind in kinds)),
        str(sum(entry.decision.chosen is not None for entry in done.decisions)),
        str(sum(kind is ProposalKind.WITHDRAWN for kind in kinds)),
        f'{sum(seconds):.1f}',
        f'{sum(seconds) / len(seconds):.1f}',
    ]


def test_there_is_a_row_for_each_trial_of_a_person() -> None:
    people = [human_record(rows) for rows in (SQUARE, ARCH)]
    assert len(printed(people[0], record(SQUARE), people[1])) == 4


def test_without_a_person_there_is_no_table() -> None:
    assert printed(record(SQUARE)) == []


def test_it_fits_into_a_narrow_terminal() -> None:
    assert printed(human_record(SQUARE), width=66)[-1][:2] == ['P01', 'small']


def test_means_are_over_the_successful_trials() -> None:
    done = record(SQUARE)
    failed = replace(done, status=TrialStatus.GAVE_UP, observations=done.observations[:1])
    rows = []
    for records in ([done, done], [done, failed, done], [failed, failed]):
        out = io.StringIO()
        print_summary(records, Console(file=out, width=100))
        (row,) = (line for line in out.getvalue().splitlines() if 'small' in line)
        rows.append(row.split())
    assert [row[1] for row in rows] == ['2/2', '2/3', '0/2']
    assert rows[1][2:] == rows[0][2:]
    assert rows[2][2:] == ['-'] * 5
