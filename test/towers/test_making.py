"""Towers that are made have the properties that were asked for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from oracles.exact import by_tiling
from oracles.shapes import measures as shape_by_twin

from blocks_planning.board.blocks import Block, Placed
from blocks_planning.board.geometry import Board
from blocks_planning.board.pictures import parse_silhouettes
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError
from blocks_planning.search.result import CancelToken
from blocks_planning.search.searches import BreadthFirst
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.towers.balancing import balanced_sets, imbalance
from blocks_planning.towers.candidates import drop_blocks, with_a_cell_changed
from blocks_planning.towers.difficulty import Planner, difficulty_of
from blocks_planning.towers.making import Made, Recipe, make_towers
from blocks_planning.towers.measures import Instruments
from blocks_planning.towers.ranges import Range, parse_range
from blocks_planning.towers.writing import format_set

SMALL = Board(5, 5)
BLOCKS = (Block(1, 1), Block(2, 1), Block(1, 2), Block(3, 1))
PLANNER = Planner(Scoping(), BreadthFirst(2), seeds=2, budget=500)


def small(**changes: object) -> Recipe:
    usual: dict[str, object] = {'board': SMALL, 'dropped': Range(3, 6), 'library': BLOCKS}
    return Recipe(**{**usual, **changes})  # type: ignore[arg-type]


@pytest.mark.parametrize('solvable', [True, False])
@pytest.mark.parametrize(
    'wanted',
    [
        {},
        {'holes': Range(1, 1)},
        {'overhangs': Range(1, 2), 'cells': Range(6, 12)},
        {'holes': Range(0, 0), 'height': Range(3, 3)},
    ],
)
def test_towers_are_as_wanted(solvable: bool, wanted: dict[str, Range]) -> None:
    made = make_towers(small(solvable=solvable, wanted=wanted), 4, seed=3)
    assert len({tower.silhouette for tower in made}) == 4
    for tower in made:
        cells = frozenset(SMALL.cells(tower.silhouette))
        shape = shape_by_twin(5, 5, cells)
        answer = by_tiling(5, 5, BLOCKS, cells, frozenset())
        assert shape.items() <= dict(tower.measures).items()
        assert tower.measures['blocks'] == (answer.fewest_blocks or 0)
        assert tower.measures['arrangements'] == answer.arrangements
        assert (answer.fewest_blocks is not None) == solvable == bool(tower.measures['solvable'])
        assert all(shape[name] in wanted[name] for name in wanted)


def test_as_many_blocks_are_dropped_as_the_range_allows() -> None:
    """Both ends included."""
    recipe = small(library=(Block(1, 1),), dropped=Range(2, 4))
    cells = {tower.silhouette.bit_count() for tower in make_towers(recipe, 20, seed=0)}
    assert cells == {2, 3, 4}


def test_the_seed_decides() -> None:
    first, again, other = (make_towers(small(), 3, seed) for seed in (1, 1, 2))
    assert first == again != other
    assert make_towers(small(), 5, 1)[:3] == first


def test_a_changed_cell_is_of_the_tower_or_beside_it() -> None:
    """Also at the edges of the board."""
    board = Board(3, 3)
    for cell in board.cells(board.full):
        tower = board.mask([cell])
        changed = {
            next(board.cells(tower ^ with_a_cell_changed(board, tower, np.random.default_rng(i))))
            for i in range(60)
        }
        column, row = cell
        near = {cell, (column - 1, row), (column + 1, row), (column, row - 1), (column, row + 1)}
        assert changed == near & set(board.cells(board.full))


def test_a_dropped_tower_is_connected_and_is_built_as_it_says() -> None:
    for seed in range(30):
        candidate = drop_blocks(SMALL, BLOCKS, 5, np.random.default_rng(seed))
        if candidate is None:
            continue
        filled: set[tuple[int, int]] = set()
        for placed in candidate.placements:
            cells = {
                (placed.column + i, placed.row + j)
                for i in range(placed.width)
                for j in range(placed.height)
            }
            beside = {
                (c + i, r + j) for c, r in cells for i, j in ((1, 0), (-1, 0), (0, 1), (0, -1))
            }
            assert not filled or beside & filled
            assert not cells & filled
            filled |= cells
        assert filled == set(SMALL.cells(candidate.silhouette))


def test_difficulty_is_the_mean_over_seeded_trials() -> None:
    recipe = small(wanted={'cost': Range(1)}, instruments=Instruments(PLANNER))
    for tower in make_towers(recipe, 2, 0):
        task = Task(tower.board, tower.silhouette, BLOCKS)
        found = difficulty_of(task, PLANNER)
        assert found is not None
        assert found.items() <= dict(tower.measures).items()
        alone = [difficulty_of(task, Planner(Scoping(), BreadthFirst(2), 1, 500))]
        assert found['cost'] >= 1
        assert alone[0] is not None
        assert 0 <= found['success'] <= 1


@pytest.mark.parametrize('stands', [True, False])
def test_loose_blocks_are_judged_by_the_statics_that_are_given(stands: bool) -> None:
    seen: list[Sequence[Placed]] = []

    def holds(blocks: Sequence[Placed]) -> bool:
        seen.append(blocks)
        return stands

    wanted = {'loose': Range(int(stands), int(stands))}
    made = make_towers(small(wanted=wanted, instruments=Instruments(holds=holds)), 2, 0)
    assert [tower.measures['loose'] for tower in made] == [stands, stands]
    assert {len(blocks) for blocks in seen} >= ({1, 2, 3} if stands else {1})


def test_what_cannot_be_had_is_said_with_what_was_missed() -> None:
    with pytest.raises(
        ConfigurationError, match=r'found 0 of 2 towers among 60.*failed: holes 20'
    ):
        make_towers(small(wanted={'holes': Range(20, 20)}, tries=30), 2, 0)


def test_a_cancelled_call_gives_what_there_is() -> None:
    token = CancelToken()
    token.cancel()
    assert make_towers(small(), 2, 0, token) == []


@pytest.mark.parametrize(
    ('changes', 'said'),
    [
        ({'wanted': {'beauty': Range()}}, "unknown measure 'beauty'; expected one of cells"),
        ({'wanted': {'loose': Range()}}, "measure 'loose' needs statics"),
        ({'wanted': {'cost': Range()}}, "measure 'cost' needs a planner"),
        ({'dropped': Range(0, 3)}, 'blocks to drop must be 1 to 25, got 0-3'),
        ({'dropped': Range(3, 26)}, 'got 3-26'),
    ],
)
def test_a_recipe_that_cannot_be_is_refused(changes: dict[str, object], said: str) -> None:
    with pytest.raises(ConfigurationError, match=said):
        small(**changes)


@pytest.mark.parametrize(
    ('text', 'expected'),
    [('3', Range(3, 3)), ('3-5', Range(3, 5)), ('3-', Range(3)), ('-5', Range(0, 5)), ('0.5', Range(0.5, 0.5))],
)  # fmt: skip
def test_ranges(text: str, expected: Range) -> None:
    assert parse_range(text, 'x') == expected


@pytest.mark.parametrize('text', ['', '-', 'a', '5-3', '3--5', '3 5', '1e3', '35 '[:0]])
def test_a_range_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(ConfigurationError, match=r'^--want holes: '):
        parse_range(text, '--want holes')


def a_tower(cells: float, cost: float) -> Made:
    return Made(SMALL, int(cells * 1000 + cost), {'cells': cells, 'cost': cost})


def test_sets_are_balanced_on_the_named_measures() -> None:
    rng = np.random.default_rng(5)
    towers = [
        a_tower(float(rng.integers(5, 25)), float(rng.integers(100, 999))) for _ in range(24)
    ]
    sets = balanced_sets(towers, 3, 6, ['cells', 'cost'], 0)
    assert [len(group) for group in sets] == [6, 6, 6]
    assert len({id(tower) for group in sets for tower in group}) == 18
    means = np.array(
        [[np.mean([t.measures[n] for t in g]) for n in ('cells', 'cost')] for g in sets]
    )
    spread = np.array([[t.measures[n] for n in ('cells', 'cost')] for t in towers]).std(axis=0)
    assert (np.ptp(means, axis=0) / spread < 0.1).all()
    assert sets == balanced_sets(towers, 3, 6, ['cells', 'cost'], 0)


def test_imbalance_by_hand() -> None:
    assert imbalance(np.array([[0.0], [2.0], [3.0], [3.0]]), 2) == pytest.approx(2.0)


@pytest.mark.parametrize(
    ('sets', 'names', 'said'),
    [
        (4, ['cells'], 'need at least 8 towers, got 6'),
        (2, ['holes'], "measure 'holes' is missing"),
    ],
)
def test_sets_that_cannot_be_are_refused(sets: int, names: list[str], said: str) -> None:
    with pytest.raises(ConfigurationError, match=said):
        balanced_sets([a_tower(number, 1) for number in range(6)], sets, 2, names, 0)


def test_what_is_written_is_read_back_with_its_measures_above() -> None:
    made = make_towers(small(wanted={'holes': Range(1, 2)}), 2, 0)
    text = format_set('made', made, ['made with care'])
    read = parse_silhouettes(text, 'x')
    assert list(read.values()) == [(tower.board, tower.silhouette) for tower in made]
    assert list(read) == ['made-1', 'made-2']
    assert f'holes {made[0].measures["holes"]}' in text
