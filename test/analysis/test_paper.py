"""The file of the paper's numbers: complete, consistent with itself, and refused where it is not."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
import yaml

from blocks_planning.analysis.bootstrap import ITERATIONS
from blocks_planning.analysis.paper import SIGNIFICANT, TWO_SIDED, Claim, Kind
from blocks_planning.analysis.paper_file import DATA, read_paper, the_paper
from blocks_planning.analysis.verdicts import leaves_out_0
from blocks_planning.errors import ConfigurationError
from blocks_planning.experiments.reading import find_sweep, read_sweep
from blocks_planning.search.result import DEFAULT_BUDGET
from blocks_planning.subgoals.scoping import Scoping

PAPER = the_paper()
CONTRADICTED = {'astar.scoping-minus-none.blocks', 'astar.scoping-minus-full.blocks'}


def section(claim: Claim) -> str:
    return str(claim.path[0])


def test_every_section_is_complete() -> None:
    """Table 1 has nine rows with two numbers; the others a number for BFS and one for A*."""
    assert Counter(map(section, PAPER.claims)) == {
        'table1': 18,
        'planners': 16,
        'differences': 12,
        'lambda': 10,
    }
    names = [claim.id for claim in PAPER.claims]
    assert len(set(names)) == len(names)


def test_kinds_are_told_apart() -> None:
    """What only the published analysis has: costs and success of planners on their own."""
    analysis = [claim for claim in PAPER.claims if claim.printed is None]
    assert len(analysis) == 10
    assert {section(claim) for claim in analysis} == {'planners'}
    both = {claim.id for claim in PAPER.claims if claim.printed and claim.analysis}
    assert both == CONTRADICTED
    for claim in PAPER.claims:
        for reported, kind in ((claim.printed, Kind.PRINTED), (claim.analysis, Kind.ANALYSIS)):
            assert reported is None or (reported.kind is kind and reported.source)


def test_all_printed_effects_have_interval_and_p() -> None:
    for claim in PAPER.claims:
        if claim.is_effect:
            assert claim.printed is not None
            assert claim.printed.interval is not None
            assert claim.printed.p is not None
        elif section(claim) == 'table1':
            assert claim.printed is not None
            assert claim.printed.interval is not None


def test_contradictions_are_those_that_are_told() -> None:
    """Interval and p, read two-sided, agree on whether an effect can be told from 0; or it is told."""
    contradicted = set()
    for claim in PAPER.claims:
        reported = claim.printed
        if not claim.is_effect or reported is None or reported.value is None:
            continue
        low, high = reported.bounds
        holds = low <= reported.value + 1e-6 and reported.value - 1e-6 <= high
        told = leaves_out_0(reported.bounds)
        assert reported.p is not None
        if not holds or told != (TWO_SIDED * reported.p < SIGNIFICANT):
            contradicted.add(claim.id)
    assert contradicted == CONTRADICTED
    assert {claim.id for claim in PAPER.claims if claim.contradiction} == CONTRADICTED


def test_sweep_is_set_up_as_the_paper_was() -> None:
    sweep, design = read_sweep(find_sweep('paper')), PAPER.design
    assert len(sweep.towers) == design['silhouettes']
    assert len(sweep.seeds) == design['seeds']
    assert design['bootstrap_iterations'] == ITERATIONS
    assert design['budget'] == DEFAULT_BUDGET
    for experiment in sweep.experiments[1:]:
        [search] = experiment.searches
        assert experiment.budget == design['budget']
        key = 'depth' if search.name == 'bfs' else 'iterations'
        assert getattr(search, key) == design[key]
        lambdas = [s.lam for s in experiment.strategies if isinstance(s, Scoping)]
        assert (min(lambdas), max(lambdas)) == (0, design['largest_lambda'][search.name])
        is_extra = experiment.seeds is not None
        assert len(lambdas) == (4 if is_extra else design['lambdas'])
        assert len(experiment.strategies) == len(lambdas) + (0 if is_extra else 2)


def test_every_combination_of_settings_is_run_at_common_values_of_lambda() -> None:
    common: dict[tuple[str, str], set[float]] = {}
    combinations = set()
    for experiment in read_sweep(find_sweep('paper')).experiments[1:]:
        [search] = experiment.searches
        for planner in experiment.strategies:
            if isinstance(planner, Scoping):
                combinations.add((search, planner.commit))
                common.setdefault((str(search), planner.commit), set()).add(round(planner.lam, 9))
    assert len(combinations) == len(common) == 8
    by_search = [
        set.intersection(*(v for (s, _), v in common.items() if s.startswith(name)))
        for name in ('BreadthFirst', 'AStar')
    ]
    assert [len(shared) for shared in by_search] == [4, 4]


def test_sweep_has_every_row_of_table_1() -> None:
    [table1] = [e for e in read_sweep(find_sweep('paper')).experiments if e.budget == 0]
    there = [{'search': search.name, **vars(search)} for search in table1.searches]
    for claim in PAPER.claims:
        if section(claim) == 'table1':
            of = claim.path[1]
            assert isinstance(of, dict)
            assert any(of.items() <= search.items() for search in there), claim.id


@pytest.mark.parametrize(
    ('old', 'new', 'error'),
    [
        (
            'value: 82.9436',
            'value: 99',
            r'the interval \[82.0, 84.8\] does not contain the value 99',
        ),
        ('interval: [82.0, 84.8]', 'interval: [84.8, 82.0]', r'expected \[low, high\]'),
        ('interval: [82.0, 84.8]', 'interval: [82.0]', r'expected \[low, high\]'),
        ('value: 82.9436', 'value: many', 'expected a number, got'),
        ('value: 82.9436', 'value: .nan', 'expected a number, got'),
        ('p: 0.0415', 'p: 4', 'expected a p-value'),
        ('p: 0.0415', 'p: small', 'expected a p-value'),
        ('p: 0.0415, source: Results', 'p: 0.0415', "missing key 'source'"),
        ('p: 0.0415', 'q: 0.0415', 'unknown key'),
        ('measure: blocks}', 'measure: bricks}', "'bricks' is not a measure"),
        ('{search: random}', '{search: dfs}', 'expected a search of'),
        ('{A: {value: 54176, source: analysis}}', '{}', 'expected a number of kind P or A'),
        ('{A: {value: 54176, source: analysis}}', '{A: {source: analysis}}', 'expected a value'),
    ],
)
def test_spoilt_file_is_refused_with_its_line(
    tmp_path: Path, old: str, new: str, error: str
) -> None:
    text = DATA.read_text(encoding='utf-8')
    assert old in text
    path = tmp_path / 'paper.yaml'
    path.write_text(text.replace(old, new, 1), encoding='utf-8')
    with pytest.raises(ConfigurationError, match=error) as caught:
        read_paper(path)
    assert f'{path}, line ' in str(caught.value)


def test_presets_differ_in_settings_that_exist() -> None:
    assert {switch['setting'] for switch in PAPER.switches} == {
        *('commit', 'dead_ends', 'divisor', 'execute')
    }
    content = yaml.safe_load(DATA.read_text(encoding='utf-8'))
    assert len(content['switches']) == len(PAPER.switches)
