"""Looking ahead, held to its slow twin: sequences, costs, values, probabilities and choice."""

from __future__ import annotations

import random
from collections import Counter
from typing import Any

import builders
import pytest
from oracles import lookahead as oracle
from oracles.randomness import subgoal_generator

from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError, LimitExceeded
from blocks_planning.search.many import solve_many
from blocks_planning.search.result import Problem, SolveStatus
from blocks_planning.search.searches import make_search
from blocks_planning.subgoals import lookahead
from blocks_planning.subgoals.choosing import drawn
from blocks_planning.subgoals.decision import Candidate, Decision, Situation, Strategy
from blocks_planning.subgoals.registry import make_strategy

SEARCHES: list[tuple[str, dict[str, Any]]] = [('random', {}), ('bfs', {'depth': 1})]
BUDGET = 20


def decide(strategy: Strategy, task: Task, built: Mask, seed: int, search: Any) -> Decision:
    """Ask a planner, and solve what it asks, until it decides."""
    known: dict[Any, Any] = {}
    while True:
        answer = strategy.decide(Situation(task, built, seed, known))
        if isinstance(answer, Decision):
            return answer
        assert answer
        assert len(set(answer)) == len(answer)
        assert not set(answer) & set(known)
        problems = [Problem(task, *query) for query in answer]
        known.update(
            zip(answer, solve_many(problems, search, seed, BUDGET, workers=1), strict=True)
        )


def random_settings(source: random.Random) -> dict[str, Any]:
    """Settings of scoping that look ahead."""
    rectangles = {
        'regions': 'rectangles',
        'min_cells': source.choice([1, 2]),
        'max_cells': source.choice([0, 3, 9]),
    }
    return {
        'lambda': source.choice([0.0, 0.05, 0.5]),
        'horizon': source.choice([1, 2, 2, 3]),
        'max_sequences': source.choice([7, 100_000]),
        **source.choice([rectangles, rectangles, {'regions': 'rows'}]),
    }


class Twin:
    """The slow twin of a decision."""

    def __init__(self, task: Task, built: Mask, seed: int, settings: dict[str, Any]) -> None:
        self.board, self.library = task.board, [tuple(block) for block in task.library]
        self.silhouette, self.built = self.cells(task.silhouette), self.cells(built)
        self.seed, self.settings = seed, settings
        sides = self.board.width, self.board.height
        ways = (
            oracle.ways_by_rows(sides[1], self.silhouette)
            if settings['regions'] == 'rows'
            else oracle.ways_by_rectangles(
                *sides, self.silhouette, settings['min_cells'], settings['max_cells']
            )
        )
        horizon, most = settings['horizon'], settings['max_sequences']
        self.all = oracle.sequences(ways, self.silhouette, self.built, horizon)
        self.considered = oracle.sampled(
            self.all, most, horizon, seed, self.built, self.board.height
        )

    def cells(self, mask: Mask) -> frozenset[tuple[int, int]]:
        return frozenset(self.board.cells(mask))

    def weighed(self, search: tuple[str, dict[str, Any]]) -> list[oracle.Weighed]:
        return [
            oracle.weigh(
                self.board.width,
                self.board.height,
                self.library,  # type: ignore[arg-type]
                sequence,
                self.built,
                self.seed,
                self.settings['lambda'],
                BUDGET,
                search=search[0],
                **search[1],
            )
            for sequence in self.considered
        ]


def random_board(source: random.Random) -> tuple[Task, Mask]:
    """A small silhouette, and rows of it that may be built."""
    board = Board(source.randint(1, 4), source.randint(1, 3))
    silhouette = source.getrandbits(board.size) | source.getrandbits(board.size)
    task = Task(board, silhouette or 1)
    built = task.rows(1) if source.random() < 0.3 else 0
    return (task, built) if built != task.silhouette else (task, 0)


def weighed_of(decision: Decision, board: Board) -> list[oracle.Weighed]:
    """The candidates of a decision as the twin writes them."""
    return [
        oracle.Weighed(
            tuple(frozenset(board.cells(region.cells)) for region in one.regions),
            one.cells,
            one.planning_cost,
            one.value,
            one.status.value,
        )
        for one in decision.candidates
    ]


@pytest.mark.parametrize('search', SEARCHES, ids=lambda search: search[0])
def test_a_decision_is_that_of_the_slow_twin(search: tuple[str, dict[str, Any]]) -> None:
    source = random.Random(search[0])
    seen: Counter[str] = Counter()
    for _ in range(200):
        task, built = random_board(source)
        settings, seed = random_settings(source), source.getrandbits(64)
        twin = Twin(task, built, seed, settings)
        if len(twin.all) > 400:
            continue
        strategy = make_strategy('scoping', settings)
        decision = decide(strategy, task, built, seed, make_search(*search))
        weighed = twin.weighed(search)
        assert weighed_of(decision, task.board) == weighed
        assert decision.sequences == len(twin.all)
        assert decision.subgoal_planning_cost == sum(one.cost for one in weighed)
        values = [one.value for one in weighed if one.value is not None]
        ties = [
            number for number, one in enumerate(weighed) if values and one.value == max(values)
        ]
        if ties:
            generator = subgoal_generator(seed, twin.built, task.board.height)
            assert decision.chosen == ties[generator.below(len(ties))]
            (subgoal,) = decision.subgoals
            assert subgoal.region == decision.candidates[decision.chosen].regions[0]
        else:
            assert decision.chosen is None
        seen['sampled'] += decision.sequences > len(decision.candidates)
        seen['long'] += any(len(one.regions) == 3 for one in decision.candidates)
        seen['chosen'] += decision.chosen is not None
        seen['unsolved'] += any(one.value is None for one in decision.candidates)
    assert min(seen.values()) >= 10, seen


@pytest.mark.parametrize('aggregate', ['best', 'softmax'])
@pytest.mark.parametrize('temperature', [0.01, 0.7, 30.0])
def test_probabilities_are_those_of_the_slow_twin(aggregate: str, temperature: float) -> None:
    source = random.Random(f'{aggregate}{temperature}')
    compared = 0
    for _ in range(60):
        task, built = random_board(source)
        settings, seed = random_settings(source), source.getrandbits(64)
        twin = Twin(task, built, seed, settings)
        if len(twin.all) > 100:
            continue
        choice = {'choice': 'softmax', 'temperature': temperature, 'aggregate': aggregate}
        strategy = make_strategy('scoping', {**settings, **choice})
        decision = decide(strategy, task, built, seed, make_search('bfs', {'depth': 1}))
        weighed = twin.weighed(SEARCHES[1])
        expected = oracle.chances(weighed, temperature, aggregate)
        found = [one.probability for one in decision.candidates]
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-12)
        if any(expected):
            assert sum(expected) == pytest.approx(1)
            fraction = subgoal_generator(seed, twin.built, task.board.height).below(2**53) / 2**53
            assert decision.chosen is not None
            before = sum(expected[: decision.chosen])
            after = before + expected[decision.chosen]
            assert before - 1e-9 <= fraction <= after + 1e-9
            compared += 1
        else:
            assert decision.chosen is None
    assert compared >= 20


@pytest.mark.parametrize('rows', [builders.CHAIR, builders.FRAME, builders.ODD])
@pytest.mark.parametrize('lam', [0.001, 0.3])
def test_full_is_looking_ahead_to_the_end_with_rows(rows: str, lam: float) -> None:
    task, search = builders.task(rows), make_search('bfs', {'depth': 1})
    ahead = make_strategy('scoping', {'lambda': lam, 'horizon': task.board.height})
    full = make_strategy('full', {'lambda': lam})
    one, other = (decide(strategy, task, 0, 5, search) for strategy in (ahead, full))
    assert one.candidates == other.candidates
    assert len(one.candidates) > 1
    assert (one.chosen, one.subgoal_planning_cost) == (other.chosen, other.subgoal_planning_cost)
    assert one.subgoals == other.subgoals[:1]


def test_every_sample_of_sequences_is_as_likely() -> None:
    task = builders.task('##/##/##')  # rows: 3, 2+3, 1+3, 1+2 with a horizon of 2
    strategy = make_strategy('scoping', {'horizon': 2, 'max_sequences': 2})
    drawn: Counter[Any] = Counter()
    for seed in range(3000):
        situation = Situation(task, 0, seed, {})
        assert strategy.sequences(situation) == 4
        chains = strategy.chains(situation)
        drawn[tuple(tuple(region.label for region in chain) for chain in chains)] += 1
    assert len(drawn) == 6
    assert max(abs(count - 500) for count in drawn.values()) < 100  # 4.9 standard deviations


def test_aim_most_ends_a_sequence_where_nothing_can_follow() -> None:
    task = builders.task('#./##')
    built = task.board.parse(['..', '..'])
    settings = {'regions': 'rectangles', 'horizon': 3, 'max_cells': 9}
    ends = {}
    for aim in ('perfect', 'most'):
        strategy = make_strategy('scoping', {**settings, 'aim': aim})
        chains = strategy.chains(Situation(task, built, 0, {}))
        ends[aim] = {tuple(region.cells.bit_count() for region in chain) for chain in chains}
    assert ends == {'perfect': {(3,)}, 'most': {(3,), (2,)}}


def test_sequences_that_cannot_be_counted_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lookahead, 'MOST_STATES', 50)
    strategy = make_strategy('scoping', {'regions': 'rectangles', 'horizon': 3})
    with pytest.raises(LimitExceeded, match='horizon 3 with regions rectangles'):
        strategy.chains(Situation(builders.task('####/####/####/####'), 0, 77, {}))


@pytest.mark.parametrize(
    ('name', 'value'),
    [
        ('horizon', 0),
        ('horizon', 17),
        ('max_sequences', 0),
        ('max_sequences', 100_001),
        ('choice', 'worst'),
        ('temperature', 0),
        ('aggregate', 'mean'),
    ],
)
def test_bad_setting_is_refused(name: str, value: object) -> None:
    with pytest.raises(ConfigurationError, match=f'{name} must be'):
        make_strategy('scoping', {name: value})


def test_draw_beyond_the_sum_of_the_probabilities_takes_the_last_possible_candidate() -> None:
    """Rounding can leave the sum below 1."""
    candidates = [
        Candidate(builders.row_regions(1), 1, 0, 1.0, SolveStatus.SOLVED, probability)
        for probability in (1e-300, 1e-300, 0.0)
    ]
    assert [drawn(candidates, seed, 0) for seed in range(5)] == [1] * 5
    assert drawn(candidates[2:], 0, 0) is None
