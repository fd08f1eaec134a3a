"""Other ways of counting, on trials that are made so that the answer is known."""

from __future__ import annotations

from typing import Any

import pandas as pd
import pytest

from blocks_planning.analysis.comparing import NONE_KNOWN, compare, find
from blocks_planning.analysis.explanations import COUNTINGS
from blocks_planning.analysis.paper import Claim
from blocks_planning.analysis.paper_file import the_paper
from blocks_planning.analysis.trials import settings_of

OWN, ONCE, ALL, SAME_SEED = COUNTINGS
CLAIMS = {claim.id: claim for claim in the_paper().claims}
COST = 'action_planning_cost'


def trial(strategy: str, stimulus: str, **values: Any) -> dict[str, Any]:
    settings = settings_of('published')
    row = {
        'stimulus': stimulus,
        'strategy': strategy,
        'search': 'bfs',
        'budget': 100,
        'seed': 0,
        'lambda': 0.001 if strategy == 'scoping' else None,
        'commit': settings['commit'] if strategy == 'scoping' else None,
        'dead_ends': settings['dead_ends'],
        'divisor': None,
        'execute': None,
        'success': True,
        COST: 0,
        'blocks': 0,
    }
    return {**row, **values}


def table(*rows: dict[str, Any]) -> pd.DataFrame:
    words = ('stimulus', 'strategy', 'search', 'commit', 'dead_ends', 'divisor', 'execute')
    return pd.DataFrame(rows).astype(dict.fromkeys(words, 'category'))


def mean(counting: Any, trials: pd.DataFrame, claim: Claim) -> float:
    assert counting.applies(claim)
    return float(counting.measure(trials, 'published', claim).mean)


def test_planners_over_their_own_silhouettes() -> None:
    """full rebuilds a and b, none only a: 10 and 30 against 100, of a alone 10 against 100."""
    trials = table(
        trial('full', 'a', **{COST: 10}),
        trial('full', 'b', **{COST: 30}),
        trial('none', 'a', **{COST: 100}),
        trial('none', 'b', success=False, **{COST: 7}),
    )
    claim = CLAIMS['bfs.full-minus-none.action_planning_cost']
    assert mean(OWN, trials, claim) == 20 - 100


def test_one_solve_drops_out_if_it_fails() -> None:
    """a always takes 10; b takes 100 in one run of four, so that it is rarely there at all."""
    trials = table(
        trial('none', 'a', **{COST: 10}),
        trial('none', 'b', **{COST: 100}),
        *(trial('none', 'b', success=False, seed=seed) for seed in (1, 2, 3)),
    )
    claim = CLAIMS['bfs.none.action_planning_cost']
    assert mean(ONCE, trials, claim) == pytest.approx(10 * 3 / 4 + 55 / 4, abs=3)


def test_blocks_of_failed_runs_count_among_all_runs() -> None:
    trials = table(
        trial('scoping', 'a', blocks=8),
        trial('none', 'a', blocks=5),
        trial('scoping', 'b', blocks=6, success=False),
        trial('none', 'b', blocks=1, success=False),
    )
    claim = CLAIMS['bfs.scoping-minus-none.blocks']
    assert mean(ALL, trials, claim) == 7 - 3
    assert mean(OWN, trials, claim) == 8 - 5


def test_one_seed_at_every_lambda() -> None:
    """Each seed rises with lambda by itself; drawn apart, the seeds would hide it."""
    trials = table(
        *(
            trial('scoping', 'a', seed=seed, **{'lambda': lam, COST: 1000 * seed + 1e4 * lam})
            for seed in range(4)
            for lam in (0.001, 0.002, 0.003)
        )
    )
    claim = CLAIMS['bfs.r-lambda.action_planning_cost']
    assert mean(SAME_SEED, trials, claim) == pytest.approx(1)


def test_counting_applies_where_it_means_something() -> None:
    assert not OWN.applies(CLAIMS['bfs.none.success'])
    assert not ONCE.applies(CLAIMS['bfs.none.success'])
    assert not ALL.applies(CLAIMS['bfs.r-lambda.blocks'])
    assert not SAME_SEED.applies(CLAIMS['bfs.scoping-minus-none.blocks'])


def estimate(mean: float, low: float, high: float) -> dict[str, Any]:
    return {'mean': mean, 'ci': [low, high], 'p': None, 'se': None}


def results(cost: dict[str, Any]) -> dict[str, Any]:
    """The results of a preset that has one number only."""
    return {
        'planners': {'bfs': {'none': {COST: cost}}, 'astar': {}},
        'table1': [],
        'differences': [],
        'lambda': {},
    }


def test_reason_is_measured_or_none_is_known() -> None:
    trials = table(trial('none', 'a', **{COST: 50_000}))
    far, near = estimate(50_000, 40_000, 60_000), estimate(22_000, 20_000, 24_000)
    both = compare({'published': results(far), 'text': results(far)}, trials)
    [claim] = both['published']
    assert claim['against'] == 'A'
    assert claim['why'].startswith(NONE_KNOWN)
    assert 'one solve per silhouette' in claim['why']
    [claim] = compare({'published': results(far), 'text': results(near)}, trials)['published']
    assert claim['why'].startswith('Measured: it is the settings; those of preset text give')
    [claim] = compare({'published': results(near), 'text': results(far)}, trials)['published']
    assert claim['why'] == ''
    cheap = table(trial('none', 'a', **{COST: 22_000}))
    [claim] = compare({'published': results(far), 'text': results(far)}, cheap)['published']
    assert claim['why'].startswith('Measured: counted with one solve per silhouette')


def test_a_number_that_is_not_there_is_not_found() -> None:
    assert find({'a': [{'b': 1, 'c': 2}]}, ('a', {'b': 1}, 'c')) == 2
    assert find({'a': [{'b': 1}]}, ('a', {'b': 2}, 'c')) is None
    assert find({}, ('a', 'b')) is None
