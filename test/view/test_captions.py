from __future__ import annotations

from builders import row_regions

from blocks_planning.search.result import SolveStatus
from blocks_planning.search.searches import AStar, BestFirst, RandomPlacement
from blocks_planning.subgoals.decision import Candidate, Decision
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view import captions, palette
from blocks_planning.view.scene import last_scene


def candidate(value: float | None, cost: int = 1234567) -> Candidate:
    status = SolveStatus.SOLVED if value is not None else SolveStatus.BUDGET_EXHAUSTED
    return Candidate(row_regions(1, 2), 8, cost, value, status)


def decision(values: list[float | None], chosen: int | None) -> Decision:
    return Decision(0, tuple(map(candidate, values)), chosen, (), 0, len(values))


def test_every_status_has_words():
    assert set(captions.STATUS_WORDS) == set(TrialStatus)
    assert set(captions.SOLVE_WORDS) == set(SolveStatus)


def test_numbers_are_always_said_and_words_if_they_are_unusual():
    assert captions._with_settings(Scoping()) == 'scoping, lambda 0.002'
    assert captions._with_settings(Scoping(0.5, 'action')) == 'scoping, lambda 0.5, commit action'
    assert captions._with_settings(AStar()) == 'astar, iterations 4,096'
    assert captions._with_settings(BestFirst(execute='path')).endswith('4,096, execute path')
    assert captions._with_settings(RandomPlacement()) == 'random'


def test_stimulus_keeps_its_end(tower_spec):
    spec = tower_spec(name='/a/long/way/to/towers.txt/arch')
    assert captions.stimulus_of(spec, 30) == '/a/long/way/to/towers.txt/arch'
    assert captions.stimulus_of(spec, 15) == '…owers.txt/arch'
    assert captions.stimulus_of(spec, 15, palette.ASCII) == '~owers.txt/arch'


def test_outcome_is_one_line(tower_spec, recorded):
    scene = last_scene(recorded(tower_spec(name='a\nb')))
    record = scene.record
    costs = f'{record.action_planning_cost:,}, subgoal planning {record.subgoal_planning_cost:,}'
    assert captions.outcome_of(scene) == (
        f'a?b: success, {record.blocks} blocks, {record.subgoals} subgoals, '
        f'action planning {costs} [states]'
    )


def test_counted():
    counts = [captions.counted(count, 'block') for count in (0, 1, 1200)]
    assert counts == ['0 blocks', '1 block', '1,200 blocks']


def test_shortlist_of_few_is_all_of_them():
    assert captions.shortlist(decision([3, None, 5], 2), 3) == [0, 1, 2]


def test_shortlist_of_many_is_the_chosen_and_the_best():
    values = [1.0, None, 5.0, 4.0, 5.0, 2.0]
    assert captions.shortlist(decision(values, 4), 4) == [4, 2, 3, 5]
    assert captions.shortlist(decision([None] * 5, None), 2) == [0, 1]


def test_numbers_of_a_candidate():
    assert captions.numbers_of(candidate(-12345.6)) == ['8', '1,234,567', '-12,346', 'solved']
    assert captions.numbers_of(candidate(5.597999)) == ['8', '1,234,567', '5.60', 'solved']
    assert captions.numbers_of(candidate(None)) == ['8', '1,234,567', '-', 'exhausted']


def test_heights_are_cut_between_numbers():
    many = Candidate(row_regions(*range(1, 17)), 8, 1, 7.0, SolveStatus.SOLVED)
    assert captions.regions_of(many, 38, kind='rows') == ' '.join(map(str, range(1, 17)))
    for width in range(4, 38):
        text = captions.regions_of(many, width, kind='rows')
        assert len(text) <= width
        assert text[-1] == '…'
        assert list(map(int, text[:-1].split())) == list(range(1, text.count(' ') + 2))
