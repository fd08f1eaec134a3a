"""What must hold when the graph has run a script, whatever was done to it."""

from __future__ import annotations

import subprocess
import time
from pathlib import Path

from graphs import COMMAND, local_lines, record_lines

from blocks_planning.ros.bagging import bags
from faults.report import Report
from faults.subject import Subject

STOP_BOUND_S = 6.0
SECOND_RUN_BOUND_S = 180.0


def judge(subject: Subject, report: Report, script: Path, out: Path) -> None:
    """Add to the report what does not hold of records, bags, processes and a second run."""
    complain = report.complaints.append
    for left in subject.left_over(STOP_BOUND_S):
        complain(f'still there: {left}')
    console = subject.console.read_text(encoding='utf-8', errors='replace')
    if 'Traceback' in console:
        complain(f'a traceback in {subject.console}')
    expected = local_lines(script)
    report.compare(record_lines(out), expected)
    for bag in subject.bags:
        for complaint in verify_bag(bag):
            complain(f'{bag}: {complaint}')
    begun = time.monotonic()
    again = subprocess.run(
        [*COMMAND, str(script), '--out', str(out)],
        capture_output=True,
        text=True,
        timeout=SECOND_RUN_BOUND_S,
    )
    report.restarts_s.append(time.monotonic() - begun)
    if again.returncode not in (0, 1) or record_lines(out) != expected:
        complain(f'the second run ended with {again.returncode}: {again.stderr}')


def verify_bag(bag: Path) -> list[str]:
    """What does not hold in a bag, as ``blocks-planning verify`` says it."""
    bags.repair(bag)
    complaints: list[str] = []
    for trial in bags.trials_of(bag, complaints.append):
        complaints += trial.contradictions()
    return complaints
