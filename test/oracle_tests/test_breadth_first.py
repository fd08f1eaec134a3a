"""Trees and slow breadth-first search against numbers worked out in the comments."""

from __future__ import annotations

import pytest
from oracles.board import EMPTY, Block, read_picture
from oracles.breadth_first import bfs_choice, count_tree
from oracles.randomness import Generator
from oracles.tree import Task
from small_boards import DOMINOES, LYING, PAPER_LIBRARY, STANDING, TOWER_1, TOWER_6, full_task

# Trees.


@pytest.mark.parametrize(
    ('width', 'height', 'library', 'counts'),
    [
        # Standing left or right, lying, square; then one child after each but the square.
        (2, 2, PAPER_LIBRARY, [4, 4 + 3, 7]),
        # Columns 0, 1, 2; then 0-2 and 2-0; the middle one is a dead end.
        (4, 1, LYING, [3, 3 + 2, 5]),
        # One block, then the other on top.
        (1, 4, STANDING, [1, 2, 2]),
        # Heights 1 or 2; 1+1, 1+2, 2+1; 1+1+1.
        (1, 3, ((1, 1), (1, 2)), [2, 2 + 3, 2 + 3 + 1]),
        # Standing 3, lying 2. After a standing one: two standing, two lying (on the outside one
        # on the ground and one bridging, in the middle both bridging): 4 each. After a lying
        # one: three standing, two lying: 5 each.
        (3, 3, DOMINOES, [5, 5 + 3 * 4 + 2 * 5]),
        # Standing 3, lying 2, square 2. After standing left: 4 as above and a square on the
        # right: 5; right: 5; middle: 4. After lying: 5 as above and two squares: 7 each. After
        # a square: one standing beside it, two lying on it: 3 each.
        (3, 3, PAPER_LIBRARY, [7, 7 + (5 + 4 + 5) + 2 * 7 + 2 * 3]),
    ],
)
def test_tree_sizes(
    width: int, height: int, library: tuple[Block, ...], counts: list[int]
) -> None:
    task = full_task(width, height, library)
    assert [count_tree(task, EMPTY, depth + 1) for depth in range(len(counts))] == counts


@pytest.mark.parametrize(
    ('picture', 'counts'),
    [(TOWER_1, [22, 394, 5695]), (TOWER_6, [16, 226, 2936])],
    ids=['tower 1', 'tower 6'],
)
def test_tree_sizes_of_towers(picture: str, counts: list[int]) -> None:
    width, height, silhouette = read_picture(picture)
    task = Task(width, height, PAPER_LIBRARY, silhouette)
    assert [count_tree(task, EMPTY, depth) for depth in (1, 2, 3)] == counts
    # No tower can be finished this early, so this is what bfs pays for its first decision.
    for depth, count in zip((1, 2, 3), counts, strict=True):
        assert bfs_choice(task, EMPTY, Generator(0), depth=depth).cost == count


# Breadth-first.


def test_bfs_stops_when_it_takes_up_a_complete_state() -> None:
    # 4 at depth 1; expanding the first three gives one each; the fourth is the complete square.
    generator = Generator(0)
    choice = bfs_choice(full_task(2, 2, PAPER_LIBRARY), EMPTY, generator, depth=2)
    assert choice.placements == ((2, 2, 0, 0),)
    assert choice.cost == 7
    assert generator.draws == 0


def test_bfs_stops_earlier_when_the_complete_state_comes_first() -> None:
    library = ((2, 2), (1, 2))
    choice = bfs_choice(full_task(2, 2, library), EMPTY, Generator(0), depth=2)
    assert choice.placements == ((2, 2, 0, 0),)
    assert choice.cost == 3


def test_bfs_executes_a_path_found_by_the_early_stop_whole() -> None:
    # 1 at each of the first two levels; the third level takes up the complete state first.
    choice = bfs_choice(full_task(1, 4, STANDING), EMPTY, Generator(0), depth=3)
    assert choice.placements == ((1, 2, 0, 0), (1, 2, 0, 2))
    assert choice.cost == 2


def test_bfs_executes_one_placement_when_the_complete_state_is_at_the_last_level() -> None:
    generator = Generator(0)
    choice = bfs_choice(full_task(1, 4, STANDING), EMPTY, generator, depth=2)
    assert choice.placements == ((1, 2, 0, 0),)
    assert choice.cost == 2
    assert generator.draws == 1


def test_bfs_avoids_dead_ends() -> None:
    # The middle column is a dead end: columns 0 and 2 are the two best nodes.
    for key in range(20):
        choice = bfs_choice(full_task(4, 1, LYING), EMPTY, Generator(key), depth=1)
        assert choice.placements == ((2, 1, [0, 2][Generator(key).below(2)], 0),)
        assert choice.cost == 3


def test_bfs_prefers_fewer_cells_to_a_dead_end_with_more() -> None:
    # A block of three leaves one cell that nothing fits; a block of two at a side does not.
    for key in range(20):
        choice = bfs_choice(full_task(4, 1, ((3, 1), (2, 1))), EMPTY, Generator(key), depth=1)
        assert choice.placements == ((2, 1, [0, 2][Generator(key).below(2)], 0),)
        assert choice.cost == 5


def test_bfs_prefers_more_cells_if_it_ignores_dead_ends() -> None:
    # Lying three fills more than lying two, and leaves room for neither.
    library = ((3, 1), (2, 1))
    for key in range(20):
        task = full_task(4, 1, library)
        choice = bfs_choice(task, EMPTY, Generator(key), depth=1, dead_ends='ignored')
        assert choice.placements[0].width == 3
    with pytest.raises(ValueError, match="dead_ends must be 'worst' or 'ignored', got 'best'"):
        bfs_choice(full_task(4, 1, library), EMPTY, Generator(0), depth=1, dead_ends='best')


def test_bfs_prefers_inner_nodes_to_leaves_that_are_dead_ends() -> None:
    # Five cells, blocks of two: columns 0, 1, 2, 3, each with a child; then 0-2, 0-3, 1-3, 2-0,
    # 3-0, 3-1, all of them dead ends. The best nodes are the four inner ones.
    for key in range(20):
        choice = bfs_choice(full_task(5, 1, LYING), EMPTY, Generator(key), depth=2)
        assert choice.placements == ((2, 1, Generator(key).below(4), 0),)
        assert choice.cost == 10


def test_bfs_finds_all_dead_ends_equally_bad() -> None:
    # The cell at the left fits no block. Two at columns 2 or 3 or three at 2: with 2, 2 and 3
    # cells, all of them dead ends.
    width, height, region = read_picture('#.###')
    task = Task(width, height, ((2, 1), (3, 1)), region)
    leaves = [(2, 1, 2, 0), (2, 1, 3, 0), (3, 1, 2, 0)]
    for key in range(20):
        choice = bfs_choice(task, EMPTY, Generator(key), depth=1)
        assert choice.placements == (leaves[Generator(key).below(3)],)
        assert choice.cost == 3


def test_bfs_depth_must_be_positive() -> None:
    with pytest.raises(ValueError, match='depth'):
        bfs_choice(full_task(2, 2, LYING), EMPTY, Generator(0), depth=0)
