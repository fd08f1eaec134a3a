"""Whole trials: all 16 towers with 32 seeds, and what they take in memory."""

from __future__ import annotations

import resource
import time
from collections.abc import Iterator

from benchmarks.measure import Figure
from benchmarks.search import TASKS
from blocks_planning.search.searches import AStar, BreadthFirst, Search
from blocks_planning.subgoals.decision import Strategy
from blocks_planning.subgoals.full import FullSubgoals
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus


def _run_all(strategy: Strategy, search: Search, seeds: int) -> list[TrialRecord]:
    return [
        run_trial(TrialSpec(f'cogsci2021/{number}', task, strategy, search, seed))
        for number, task in enumerate(TASKS, start=1)
        for seed in range(seeds)
    ]


def run(quick: bool) -> Iterator[Figure]:
    """Seconds, and what came out."""
    seeds = 2 if quick else 32
    for strategy, search, target in (
        (Scoping(), BreadthFirst(), '< 20'),
        (FullSubgoals(), BreadthFirst(), ''),
        (NoSubgoals(), BreadthFirst(), ''),
        (Scoping(), AStar(), ''),
    ):
        name = f'{strategy.name}, {search.name}, 16 towers, {seeds} seeds'
        run_trial(TrialSpec('warm', TASKS[4], strategy, search))
        start = time.perf_counter()
        records = _run_all(strategy, search, seeds)
        taken = time.perf_counter() - start
        done = [record for record in records if record.status is TrialStatus.SUCCESS]
        yield Figure(name, taken, 's', target)
        yield Figure('  success', len(done) / len(records), '')
        cost = sum(record.action_planning_cost for record in done) / max(1, len(done))
        yield Figure('  action planning cost', cost, 'states')
        considered = sum(record.subgoal_planning_cost for record in done) / max(1, len(done))
        yield Figure('  subgoal planning cost', considered, 'states')
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    yield Figure('peak memory of this process', peak, 'MB', '< 1000')
