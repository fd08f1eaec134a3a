"""The oracles against numbers worked out by hand; the working is in the comments."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import pytest
from oracles import exact, planners
from oracles.board import (
    EMPTY,
    Block,
    Cell,
    Cells,
    Placement,
    cells_of,
    drop,
    is_dead,
    legal_placements,
    place,
    possible_placements,
    read_picture,
    rows,
)
from oracles.randomness import (
    Generator,
    attempt_generator,
    key_from_words,
    mask_of,
    subgoal_generator,
    words_of,
)
from oracles.search import (
    Node,
    Queue,
    Task,
    astar_choice,
    attempt,
    best_first_choice,
    bfs_choice,
    count_tree,
    f_largest,
    f_left_only,
    f_mean,
    f_smallest,
    random_choice,
)

PAPER_LIBRARY = ((1, 2), (2, 1), (2, 2), (2, 4), (4, 2))
LYING = ((2, 1),)
STANDING = ((1, 2),)
DOMINOES = ((1, 2), (2, 1))

TOWER_1 = """
##..####
##..####
##..#..#
##..#..#
##..#..#
##.##..#
##.#####
########
"""

TOWER_6 = """
####.##.
####.##.
####.##.
##.#####
##.#####
####..##
########
.##.####
"""

# Three cells: two on the ground and one on top of the left one.
STEP = """
#.
##
"""


def full_board(width: int, height: int) -> Cells:
    return frozenset((column, row) for column in range(width) for row in range(height))


def full_task(width: int, height: int, library: tuple[Block, ...]) -> Task:
    return Task(width, height, tuple(library), full_board(width, height))


# Randomness.


def test_splitmix64_gives_its_published_numbers() -> None:
    generator = Generator(1234567)
    assert [generator.draw() for _ in range(5)] == [
        6457827717110365317,
        3203168211198807973,
        9817491932198370423,
        4593380528125082431,
        16408922859458223821,
    ]
    generator = Generator(0)
    assert [generator.draw() for _ in range(3)] == [
        0xE220A8397B1DCDAF,
        0x6E789E6AA1B965F4,
        0x06C45D188009454F,
    ]


def test_key_of_words_is_a_chain_of_first_outputs() -> None:
    # key = mix64((key ^ word) + GAMMA) is the first output of a generator with key ^ word.
    assert key_from_words([]) == 0
    assert key_from_words([0]) == 0xE220A8397B1DCDAF
    assert key_from_words([1234567]) == 6457827717110365317
    second = Generator(6457827717110365317 ^ 89).draw()
    assert key_from_words([1234567, 89]) == second
    # A second word that undoes the first key brings the key back to 0 before mixing.
    assert key_from_words([7, key_from_words([7])]) == 0xE220A8397B1DCDAF


@pytest.mark.parametrize('word', [-1, 2**64])
def test_seed_words_must_fit(word: int) -> None:
    with pytest.raises(ValueError, match='seed word'):
        key_from_words([word])


def test_below_takes_the_remainder() -> None:
    generator = Generator(1234567)
    assert [generator.below(10) for _ in range(3)] == [7, 3, 3]


def test_below_draws_also_when_there_is_nothing_to_choose() -> None:
    generator = Generator(1234567)
    assert generator.below(1) == 0
    assert generator.draws == 1
    assert generator.draw() == 3203168211198807973


def test_below_rejects_the_uneven_rest() -> None:
    # 2**64 mod (2**63 + 1) = 2**63 - 1, so numbers from 2**63 + 1 on are drawn again:
    # of the published numbers the third is one of these, the fourth is not.
    generator = Generator(1234567)
    n = 2**63 + 1
    assert generator.below(n) == 6457827717110365317
    assert generator.below(n) == 3203168211198807973
    assert generator.below(n) == 4593380528125082431
    assert generator.draws == 4


def test_below_nothing_is_an_error() -> None:
    with pytest.raises(ValueError, match='one of 0'):
        Generator(0).below(0)


def test_masks_and_their_words() -> None:
    # Height 3: (0, 0) is bit 0, (0, 2) bit 2, (1, 0) bit 3.
    assert mask_of({(0, 0), (0, 2), (1, 0)}, 3) == 1 + 4 + 8
    # Height 8: (7, 7) is bit 63, the highest of the first word.
    assert words_of(mask_of({(7, 7)}, 8)) == [2**63, 0, 0, 0]
    # Height 16: (4, 0) is bit 64, (15, 15) bit 255.
    assert words_of(mask_of({(4, 0), (15, 15)}, 16)) == [0, 1, 0, 2**63]


def test_generators_are_made_of_seed_state_region_attempt() -> None:
    state, region = frozenset({(0, 0)}), full_board(2, 2)
    expected = key_from_words([5, 1, 0, 0, 0, 15, 0, 0, 0, 3])
    assert attempt_generator(5, state, region, 2, 3).key == expected
    assert subgoal_generator(5, state, 2).key == key_from_words([5, 1, 0, 0, 0])


# Board.


def test_read_picture_puts_the_ground_at_the_bottom() -> None:
    assert read_picture(STEP) == (2, 2, frozenset({(0, 0), (1, 0), (0, 1)}))
    with pytest.raises(ValueError, match='not a row'):
        read_picture('##\n#')
    with pytest.raises(ValueError, match='not a row'):
        read_picture('#x')


def test_blocks_rest_on_the_highest_cell_under_them() -> None:
    state = frozenset({(0, 0), (2, 0), (2, 1)})
    assert drop(EMPTY, (2, 2), 1) == Placement(2, 2, 1, 0)
    assert drop(state, (1, 2), 0).row == 1
    assert drop(state, (1, 2), 1).row == 0
    assert drop(state, (2, 1), 0).row == 1
    assert drop(state, (3, 1), 0).row == 2


def test_cells_of_a_placement() -> None:
    assert cells_of(Placement(2, 1, 3, 4)) == {(3, 4), (4, 4)}
    assert cells_of(Placement(1, 2, 3, 4)) == {(3, 4), (3, 5)}


def test_placements_come_block_by_block_from_left_to_right() -> None:
    assert possible_placements(2, 2, PAPER_LIBRARY, EMPTY) == [
        (1, 2, 0, 0),
        (1, 2, 1, 0),
        (2, 1, 0, 0),
        (2, 2, 0, 0),
    ]
    assert possible_placements(2, 2, ((2, 2), (1, 2)), EMPTY) == [
        (2, 2, 0, 0),
        (1, 2, 0, 0),
        (1, 2, 1, 0),
    ]


def test_possible_is_inside_the_board() -> None:
    # On one cell in the left of a 2 x 2 board: standing blocks fit in the right column only,
    # a lying one bridges, a square does not fit any more.
    state = frozenset({(0, 0)})
    assert possible_placements(2, 2, PAPER_LIBRARY, state) == [(1, 2, 1, 0), (2, 1, 0, 1)]


def test_legal_is_inside_the_region() -> None:
    width, height, step = read_picture(STEP)
    legal = legal_placements(width, height, PAPER_LIBRARY, step, EMPTY)
    assert legal == [(1, 2, 0, 0), (2, 1, 0, 0)]


def test_dead_is_an_empty_target_cell_under_a_filled_one() -> None:
    region = full_board(2, 2)
    assert is_dead(region, frozenset({(0, 0), (0, 1), (1, 1)}))
    assert not is_dead(region, frozenset({(0, 0), (0, 1)}))
    # The empty cell under the bridge is no target.
    assert not is_dead(region - {(1, 0)}, frozenset({(0, 0), (0, 1), (1, 1)}))


def test_rows_are_the_lowest() -> None:
    step = read_picture(STEP)[2]
    assert rows(step, 0) == EMPTY
    assert rows(step, 1) == {(0, 0), (1, 0)}
    assert rows(step, 2) == step


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


# Random.


def test_random_draws_once_for_each_placement() -> None:
    task = full_task(2, 2, PAPER_LIBRARY)
    for key in range(20):
        generator = Generator(key)
        choice = random_choice(task, EMPTY, generator)
        assert choice.placements == (task.legal(EMPTY)[Generator(key).below(4)],)
        assert choice.cost == 0
        assert generator.draws == 1


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


# A* and best-first.


def test_f_is_the_float_of_its_formula() -> None:
    # Areas 2, 2, 4, 8, 8: their mean is 24 / 5.
    assert f_mean(PAPER_LIBRARY, 2, 10) == 2 + 10 / 4.8
    assert f_smallest(PAPER_LIBRARY, 2, 10) == 7
    assert f_largest(PAPER_LIBRARY, 2, 10) == 3.25
    # Five blocks more and 24 cells less make no difference, but to the last bit of the float.
    assert f_mean(PAPER_LIBRARY, 0, 24) == f_mean(PAPER_LIBRARY, 5, 0)
    assert f_mean(PAPER_LIBRARY, 0, 28) != f_mean(PAPER_LIBRARY, 5, 4)
    assert f_left_only(PAPER_LIBRARY, 2, 10) == 10


def test_queue_fills_the_gap_with_the_last_node() -> None:
    key = next(key for key in range(100) if Generator(key).below(4) == 1)
    nodes = [Node(frozenset({(column, 0)}), ()) for column in range(5)]
    queue = Queue()
    queue.add(9, nodes[4])
    for node in nodes[:4]:
        queue.add(3, node)
    assert queue.take(Generator(key)) is nodes[1]
    assert queue.lists[3] == [nodes[0], nodes[3], nodes[2]]
    for left in (3, 2, 1):
        generator = Generator(key)
        expected = queue.lists[3][Generator(key).below(left)]
        assert queue.take(generator) is expected
        assert generator.draws == 1
    assert queue.take(Generator(key)) is nodes[4]
    assert queue.is_empty()


def test_astar_takes_the_lowest_f() -> None:
    # 2 g + left: 4 for each single domino, 2 for the square, which is complete.
    generator = Generator(0)
    choice = astar_choice(full_task(2, 2, PAPER_LIBRARY), EMPTY, generator, iterations=2)
    assert choice.placements == ((2, 2, 0, 0),)
    assert choice.cost == 4
    assert generator.draws == 2


def test_astar_draws_for_the_root_too() -> None:
    # All f are 4. Iteration 2 takes one of three columns; the middle one has no children.
    for key in range(20):
        draws = Generator(key)
        draws.below(1)
        column = draws.below(3)
        choice = astar_choice(full_task(4, 1, LYING), EMPTY, Generator(key), iterations=2)
        assert choice.placements == ((2, 1, column, 0),)
        assert choice.cost == (3 if column == 1 else 4)


def test_astar_ends_with_the_last_node_taken_when_the_queue_runs_empty() -> None:
    # Columns 0 and 1, both dead ends: the one that is taken second is the result.
    for key in range(20):
        draws = Generator(key)
        draws.below(1)
        first = draws.below(2)
        generator = Generator(key)
        choice = astar_choice(full_task(3, 1, LYING), EMPTY, generator, iterations=10)
        assert choice.placements == ((2, 1, 1 - first, 0),)
        assert choice.cost == 2
        assert generator.draws == 3


def test_astar_counts_the_children_of_the_last_node_taken() -> None:
    # A column of three standing blocks: root, 1, 2 are taken, one child each.
    task = full_task(1, 6, STANDING)
    first = astar_choice(task, EMPTY, Generator(0), iterations=3, execute='first')
    whole = astar_choice(task, EMPTY, Generator(0), iterations=3, execute='path')
    assert first.cost == whole.cost == 3
    assert first.placements == ((1, 2, 0, 0),)
    assert whole.placements == ((1, 2, 0, 0), (1, 2, 0, 2))


def test_best_first_leaves_out_what_was_placed() -> None:
    # Two cells, blocks of one, largest block three: astar has f = 3 + 1 for either cell and
    # 6 + 0 for both, so iteration 3 takes the other cell; best-first has 1, 1 and 0.
    task = full_task(2, 1, ((1, 1), (1, 3)))
    for key in range(20):
        astar = astar_choice(task, EMPTY, Generator(key), iterations=3, divisor='largest')
        assert len(astar.placements) == 1
        assert astar.cost == 2 + 1 + 1
        best_first = best_first_choice(task, EMPTY, Generator(key), iterations=3)
        assert len(best_first.placements) == 2
        assert best_first.cost == 2 + 1


def test_divisors_change_the_order() -> None:
    # Four cells in a column, blocks of one, two and eight (which fits nowhere). Children of the
    # root: one (left 3), two (left 2).
    # smallest 1: f = g + left: 4, 3; then two+one 2 + 1 = 3, two+two 2 + 0 = 2: taken, complete.
    # largest 8: f = 8 g + left: 11, 10; then 17, 16: iteration 3 takes one: three children.
    # mean 11 / 3: f = 11 g + 3 left: 20, 17; then 25, 22: iteration 3 takes one as well.
    task = full_task(1, 4, ((1, 1), (1, 2), (1, 8)))
    costs = {
        divisor: astar_choice(task, EMPTY, Generator(0), iterations=3, divisor=divisor).cost
        for divisor in ('smallest', 'mean', 'largest')
    }
    assert costs == {'smallest': 2 + 2, 'mean': 2 + 2 + 2, 'largest': 2 + 2 + 2}


@pytest.mark.parametrize(
    ('settings', 'message'),
    [({'iterations': 1}, 'iterations'), ({'iterations': 2, 'execute': 'all'}, 'execute')],
)
def test_astar_settings_are_checked(settings: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        astar_choice(full_task(2, 2, LYING), EMPTY, Generator(0), **settings)


# Attempts.


def test_bfs_attempt_adds_up_its_searches() -> None:
    # Depth 2: 3 + 2 evaluated, columns 0 or 2 executed; then one child, taken up: complete.
    region = full_board(4, 1)
    for seed in range(20):
        result = attempt(4, 1, LYING, region, EMPTY, seed, 0, search='bfs', depth=2)
        column = [0, 2][attempt_generator(seed, EMPTY, region, 1, 0).below(2)]
        assert result.placements == ((2, 1, column, 0), (2, 1, 2 - column, 0))
        assert result.cost == 5 + 1
        assert result.success


def test_astar_attempt_adds_up_its_searches() -> None:
    # execute path: 3 evaluated and two placed, then 1. execute first: 3, then from one block 2.
    region = full_board(1, 6)
    costs = {
        execute: attempt(
            1, 6, STANDING, region, EMPTY, 0, 0, search='astar', iterations=3, execute=execute
        ).cost
        for execute in ('first', 'path')
    }
    assert costs == {'first': 3 + 2, 'path': 3 + 1}


def test_one_generator_serves_a_whole_attempt() -> None:
    # Random on four cells: columns 0 or 2 lead to success (the last placement draws as well),
    # the middle one is stuck.
    region = full_board(4, 1)
    ends = set()
    for seed in range(20):
        result = attempt(4, 1, LYING, region, EMPTY, seed, 7, search='random')
        column = attempt_generator(seed, EMPTY, region, 1, 7).below(3)
        assert result.placements[0] == (2, 1, column, 0)
        assert result.success == (column != 1)
        assert len(result.placements) == (1 if column == 1 else 2)
        ends.add(result.success)
    assert ends == {False, True}


def test_later_draws_of_an_attempt_go_on_with_its_generator() -> None:
    # Random with single cells on a ground of three: three, then two, then one to choose from.
    region = full_board(3, 1)
    for seed in range(20):
        draws = attempt_generator(seed, EMPTY, region, 1, 0)
        free = [0, 1, 2]
        expected = [free.pop(draws.below(len(free))) for _ in range(3)]
        result = attempt(3, 1, ((1, 1),), region, EMPTY, seed, 0, search='random')
        assert [placement.column for placement in result.placements] == expected


# Exact.


@pytest.mark.parametrize(
    ('picture', 'library', 'fewest', 'arrangements'),
    [
        # The square; two standing; two lying.
        ('## ##', PAPER_LIBRARY, 1, 3),
        # A row of n cells with blocks of one and two: Fibonacci 1, 2, 3, 5, 8.
        ('#', ((1, 1), (2, 1)), 1, 1),
        ('##', ((1, 1), (2, 1)), 1, 2),
        ('###', ((1, 1), (2, 1)), 2, 3),
        ('####', ((1, 1), (2, 1)), 2, 5),
        ('#####', ((1, 1), (2, 1)), 3, 8),
        # The same as a column.
        ('# # # # #', ((1, 1), (1, 2)), 3, 8),
        # Dominoes do not fill an odd number of cells.
        ('###', LYING, None, 0),
        ('### ### ###', DOMINOES, None, 0),
        ('### ### ###', PAPER_LIBRARY, None, 0),
        # Two rows of n with dominoes and squares: a(n) = a(n-1) + 2 a(n-2): 1, 3, 5, 11; and
        # for n = 4 the one block of 4 x 2.
        ('### ###', PAPER_LIBRARY, 2, 5),
        ('#### ####', PAPER_LIBRARY, 1, 12),
        # 3 x 3 with cells and dominoes: the centre alone leaves a ring of eight, with
        # 47 (Lucas) matchings; the centre in one of four dominoes leaves a path of seven, with
        # 21 (Fibonacci): 47 + 4 * 21. Nine cells need four dominoes and a cell.
        ('### ### ###', ((1, 1), (1, 2), (2, 1)), 5, 131),
        # The 4 x 4 board has 36 domino tilings.
        ('#### #### #### ####', DOMINOES, 8, 36),
        # A roof on a post: of its four tilings only the whole one does not fall down.
        ('### .#.', ((1, 1), (2, 1), (3, 1)), 2, 1),
        # A ring: ground in one piece or three, two walls, a roof in one piece.
        ('### #.# ###', ((1, 1), (3, 1)), 4, 2),
        # A roof on nothing.
        ('## ..', LYING, None, 0),
        # The step: one lying under nothing that fits.
        ('#. ##', DOMINOES, None, 0),
        ('#. ##', ((1, 1), (1, 2), (2, 1)), 2, 3),
        # Blocks of the same size make no difference.
        ('## ##', ((2, 1), (2, 1)), 2, 1),
        # Nothing to do is one arrangement: that of no blocks.
        ('.. ..', LYING, 0, 1),
    ],
)
def test_exact_by_hand(
    picture: str, library: tuple[Block, ...], fewest: int | None, arrangements: int
) -> None:
    width, height, region = read_picture(picture)
    expected = exact.Exact(fewest, arrangements)
    assert exact.by_dropping(width, height, library, region, EMPTY) == expected
    assert exact.by_tiling(width, height, library, region, EMPTY) == expected


@pytest.mark.parametrize(
    ('built', 'fewest', 'arrangements'),
    [
        # On a 2 x 2 board of dominoes. One standing: the other one.
        ({(0, 0), (0, 1)}, 1, 1),
        # All of it.
        ({(0, 0), (0, 1), (1, 0), (1, 1)}, 0, 1),
        # A single cell leaves three.
        ({(0, 0)}, None, 0),
        # A roof over the ground: what is left could be tiled, but not be reached.
        ({(0, 1), (1, 1)}, None, 0),
        # Something outside the region.
        ({(2, 0)}, None, 0),
    ],
)
def test_exact_from_a_built_state(built: set[Cell], fewest: int | None, arrangements: int) -> None:
    region, state = full_board(2, 2), frozenset(built)
    expected = exact.Exact(fewest, arrangements)
    assert exact.by_dropping(3, 2, DOMINOES, region, state) == expected
    assert exact.by_tiling(3, 2, DOMINOES, region, state) == expected


def random_board(rng: random.Random) -> tuple[int, int, tuple[Block, ...], Cells, Cells]:
    """A small board, library, region, and a built state: cells, or blocks dropped on it."""
    width, height = rng.randint(1, 4), rng.randint(1, 4)
    sizes = [(1, 1), (1, 2), (2, 1), (2, 2), (1, 3), (3, 1), (3, 2)]
    library = tuple(rng.sample(sizes, rng.randint(1, 3)))
    density = rng.choice([0.5, 0.8, 1.0])
    cells = sorted(full_board(width, height))
    region = frozenset(rng.sample(cells, max(1, min(10, round(density * len(cells))))))
    built = EMPTY
    if rng.random() < 0.3:
        built = frozenset(rng.sample(sorted(region), rng.randint(0, len(region))))
    else:
        for _ in range(rng.randint(0, 2)):
            legal = legal_placements(width, height, library, region, built)
            built = place(built, rng.sample(legal, min(1, len(legal))))
    return width, height, library, region, built


def test_dropping_in_any_order_is_tiling_with_support() -> None:
    rng = random.Random(20210613)
    filled = 0
    for _ in range(1500):
        board = random_board(rng)
        by_dropping = exact.by_dropping(*board)
        assert by_dropping == exact.by_tiling(*board), board
        filled += by_dropping.fewest_blocks not in (None, 0)
    assert filled > 200


@pytest.mark.parametrize(
    ('picture', 'arrangements', 'fewest'),
    [
        (TOWER_1, 12780, [4, None, 8, 6, 10, 9, 12, 10]),
        (TOWER_6, 748026, [3, 4, 4, None, 7, 10, 9, 12]),
    ],
    ids=['tower 1', 'tower 6'],
)
def test_exact_of_towers(picture: str, arrangements: int, fewest: list[int | None]) -> None:
    width, height, silhouette = read_picture(picture)
    results = [
        exact.by_tiling(width, height, PAPER_LIBRARY, rows(silhouette, k), EMPTY)
        for k in range(1, height + 1)
    ]
    assert [result.fewest_blocks for result in results] == fewest
    assert results[-1].arrangements == arrangements


# Solving.


def test_solve_of_a_filled_region_does_nothing() -> None:
    region = full_board(2, 1)
    solution = planners.solve(2, 1, LYING, region, region, 0, search='bfs', depth=1)
    assert solution == planners.Solution('solved', (), 0, 0, 0)


def test_solve_proves_when_nothing_is_legal() -> None:
    region = full_board(2, 1)
    solution = planners.solve(2, 1, STANDING, region, EMPTY, 0, search='bfs', depth=1)
    assert solution == planners.Solution('unsolvable_proven', (), 0, 0, 0)


FAILED = 'budget_exhausted'


def test_solve_finishes_the_attempt_that_crosses_the_budget() -> None:
    # Three cells, blocks of two: each attempt evaluates 2 and fails. 2, 4, 6 >= 5.
    region = full_board(3, 1)
    solution = planners.solve(3, 1, LYING, region, EMPTY, 0, search='bfs', depth=1, budget=5)
    assert (solution.status, solution.planning_cost, solution.attempts) == (FAILED, 6, 3)
    assert len(solution.last_attempt) == 1
    solution = planners.solve(3, 1, LYING, region, EMPTY, 0, search='bfs', depth=1, budget=4)
    assert (solution.status, solution.planning_cost, solution.attempts) == (FAILED, 4, 2)
    solution = planners.solve(3, 1, LYING, region, EMPTY, 0, search='bfs', depth=1, budget=0)
    assert (solution.status, solution.planning_cost, solution.attempts) == (FAILED, 2, 1)


@pytest.mark.parametrize(('budget', 'attempts'), [(0, 1), (1, 1), (5, 5)])
def test_solve_makes_as_many_free_attempts_as_the_budget_has_states(
    budget: int, attempts: int
) -> None:
    solution = planners.solve(
        3, 1, LYING, full_board(3, 1), EMPTY, 0, search='random', budget=budget
    )
    assert (solution.status, solution.planning_cost, solution.attempts) == (FAILED, 0, attempts)
    assert (solution.placements, solution.solution_cost) == ((), 0)


def test_solve_adds_up_attempts_until_one_succeeds() -> None:
    # astar with 2 iterations on four cells: with column 1 an attempt fails at 3; with 0 or 2 it
    # evaluates 4, then 1, and succeeds.
    region = full_board(4, 1)
    seen = set()
    for seed in range(30):
        failures = 0
        while True:
            draws = attempt_generator(seed, EMPTY, region, 1, failures)
            draws.below(1)
            if draws.below(3) != 1:
                break
            failures += 1
        solution = planners.solve(4, 1, LYING, region, EMPTY, seed, search='astar', iterations=2)
        assert solution.status == 'solved'
        assert solution.attempts == failures + 1
        assert solution.solution_cost == 5
        assert solution.planning_cost == 3 * failures + 5
        seen.add(failures)
    assert {0, 1, 2} <= seen


def test_solve_asks_for_a_region_that_contains_what_is_built() -> None:
    with pytest.raises(ValueError, match='outside the region'):
        planners.solve(2, 1, LYING, EMPTY, frozenset({(0, 0)}), 0, search='bfs', depth=1)


# Planners: no subgoals.


def test_none_plans_the_whole() -> None:
    # 2 x 2 with lying blocks: one child, then one.
    trial = planners.none(2, 2, full_board(2, 2), LYING, search='bfs', depth=1)
    assert trial.status == 'success'
    assert trial.placements == ((2, 1, 0, 0), (2, 1, 0, 1))
    assert (trial.blocks, trial.subgoals) == (2, 1)
    assert trial.action_planning_cost == trial.solution_cost == 2
    assert trial.subgoal_planning_cost == 0
    assert trial.decisions == (
        planners.Decision(EMPTY, (planners.Candidate(2, 4, 2, None, 'solved'),), 2),
    )


def test_none_carries_out_its_last_attempt() -> None:
    # The step with dominoes: standing or lying, both dead ends: 2 + 2 >= 3.
    width, height, step = read_picture(STEP)
    trial = planners.none(width, height, step, DOMINOES, search='bfs', depth=1, budget=3)
    assert trial.status == 'stuck'
    assert (trial.blocks, trial.subgoals, trial.action_planning_cost) == (1, 1, 4)
    (decision,) = trial.decisions
    assert decision.candidates == (planners.Candidate(2, 3, 4, None, 'budget_exhausted'),)
    assert decision.chosen == 2


@pytest.mark.parametrize('planner', [planners.none, planners.scoping, planners.full])
def test_trials_that_are_over_before_they_begin(planner: Callable[..., planners.Trial]) -> None:
    settings = {} if planner is planners.none else {'lam': 1.0}
    trial = planner(2, 2, EMPTY, LYING, search='random', **settings)
    assert trial == planners.Trial('success', (), 0, 0, 0, 0, 0, ())
    floating = frozenset({(0, 1), (1, 1)})
    trial = planner(2, 2, floating, LYING, search='random', **settings)
    assert trial == planners.Trial('stuck', (), 0, 0, 0, 0, 0, ())


# Planners: scoping.


def test_region_heights_skip_what_adds_nothing() -> None:
    # Ground row empty: rows(1) is what is built. Row 3 empty: rows(4) is rows(3).
    picture = read_picture('# . # # .')[2]
    assert planners.region_heights(picture, 5, EMPTY) == [2, 3, 5]
    assert planners.region_heights(picture, 5, rows(picture, 2)) == [3, 5]
    # Rows 1 and 2 are partly built: rows(1) does not contain that, rows(2) equals it.
    square = full_board(2, 3)
    assert planners.region_heights(square, 3, frozenset({(0, 0)})) == [1, 2, 3]
    assert planners.region_heights(square, 3, frozenset({(0, 0), (0, 1)})) == [2, 3]
    assert planners.region_heights(square, 3, square) == []


def scope_square(lam: float, seed: int = 0, **settings: Any) -> planners.Trial:
    return planners.scoping(
        2, 2, full_board(2, 2), LYING, EMPTY, seed, search='bfs', depth=1, lam=lam, **settings
    )


def test_scoping_weighs_cells_against_cost() -> None:
    # rows(1): 2 cells for 1; rows(2): 4 cells for 2. lambda 1: V = 1 and 2.
    trial = scope_square(1.0)
    assert trial.status == 'success'
    assert (trial.blocks, trial.subgoals) == (2, 1)
    assert trial.action_planning_cost == trial.solution_cost == 2
    assert trial.subgoal_planning_cost == 1 + 2
    (decision,) = trial.decisions
    assert decision.candidates == (
        planners.Candidate(1, 2, 1, 1.0, 'solved'),
        planners.Candidate(2, 4, 2, 2.0, 'solved'),
    )
    assert decision.chosen == 2


def test_scoping_takes_small_steps_when_planning_is_dear() -> None:
    # lambda 3: V = -1 and -2: rows(1); then rows(2): 2 cells for 1.
    trial = scope_square(3.0)
    assert trial.status == 'success'
    assert (trial.blocks, trial.subgoals) == (2, 2)
    assert trial.action_planning_cost == trial.solution_cost == 1 + 1
    assert trial.subgoal_planning_cost == (1 + 2) + 1
    assert [decision.chosen for decision in trial.decisions] == [1, 2]
    assert trial.decisions[1].built == {(0, 0), (1, 0)}
    assert trial.decisions[1].candidates == (planners.Candidate(2, 2, 1, -1.0, 'solved'),)


def test_scoping_breaks_ties_with_its_own_generator() -> None:
    # lambda 2: V = 0 and 0.
    seen = set()
    for seed in range(20):
        chosen = scope_square(2.0, seed).decisions[0].chosen
        assert chosen == [1, 2][subgoal_generator(seed, EMPTY, 2).below(2)]
        seen.add(chosen)
    assert seen == {1, 2}


def test_scoping_that_commits_to_actions_scopes_after_each() -> None:
    # lambda 1: rows(2) is chosen for 2 (rows(1) costs 1), its first block placed; then for 1.
    trial = scope_square(1.0, commit='action')
    assert trial.status == 'success'
    assert [decision.chosen for decision in trial.decisions] == [2, 2]
    assert (trial.blocks, trial.subgoals) == (2, 2)
    assert trial.action_planning_cost == trial.solution_cost == 2 + 1
    assert trial.subgoal_planning_cost == (1 + 2) + 1


def test_scoping_gets_stuck() -> None:
    # The step with dominoes: rows(1) is one lying block for 1; rows(2) fails twice for 2. On the
    # lying block nothing fits.
    width, height, step = read_picture(STEP)
    trial = planners.scoping(
        width, height, step, DOMINOES, search='bfs', depth=1, lam=0.0, budget=3
    )
    assert trial.status == 'stuck'
    assert trial.placements == ((2, 1, 0, 0),)
    assert (trial.subgoals, trial.action_planning_cost, trial.solution_cost) == (1, 1, 1)
    assert trial.subgoal_planning_cost == 1 + 4
    assert trial.decisions[0].candidates == (
        planners.Candidate(1, 2, 1, 2.0, 'solved'),
        planners.Candidate(2, 3, 4, None, 'budget_exhausted'),
    )


def test_scoping_gives_up() -> None:
    # The step with standing blocks: rows(1) has nothing legal; rows(2) fails three times for 1.
    width, height, step = read_picture(STEP)
    trial = planners.scoping(
        width, height, step, STANDING, search='bfs', depth=1, lam=0.0, budget=3
    )
    assert trial.status == 'gave_up'
    assert (trial.blocks, trial.subgoals, trial.action_planning_cost) == (0, 0, 0)
    assert trial.subgoal_planning_cost == 0 + 3
    (decision,) = trial.decisions
    assert decision.chosen is None
    assert decision.candidates == (
        planners.Candidate(1, 2, 0, None, 'unsolvable_proven'),
        planners.Candidate(2, 3, 3, None, 'budget_exhausted'),
    )


def test_scoping_goes_on_from_what_is_built() -> None:
    built = frozenset({(0, 0), (1, 0)})
    trial = planners.scoping(2, 2, full_board(2, 2), LYING, built, search='bfs', depth=1, lam=0.0)
    assert trial.placements == ((2, 1, 0, 1),)
    assert trial.decisions[0].candidates == (planners.Candidate(2, 2, 1, 2.0, 'solved'),)


def test_scoping_knows_its_commit_modes() -> None:
    with pytest.raises(ValueError, match='commit'):
        scope_square(1.0, commit='plan')


# Planners: full.


def test_sequences_are_all_that_end_in_the_whole() -> None:
    assert planners.sequences_of([1, 2, 5]) == [(1, 2, 5), (1, 5), (2, 5), (5,)]
    assert planners.sequences_of([3]) == [(3,)]
    assert len(planners.sequences_of(range(1, 9))) == 128


def test_full_counts_every_subgoal_of_every_sequence() -> None:
    # (1, 2): 1 + 1. (2): 2. V = 4 - 2 lambda for both: a tie.
    seen = set()
    for seed in range(20):
        trial = planners.full(2, 2, full_board(2, 2), LYING, seed, search='bfs', depth=1)
        assert trial.status == 'success'
        assert trial.placements == ((2, 1, 0, 0), (2, 1, 0, 1))
        assert trial.action_planning_cost == trial.solution_cost == 2
        assert trial.subgoal_planning_cost == 2 + 2
        (decision,) = trial.decisions
        assert decision.candidates == (
            planners.Candidate((1, 2), 4, 2, 2.0, 'solved'),
            planners.Candidate((2,), 4, 2, 2.0, 'solved'),
        )
        expected = [(1, 2), (2,)][subgoal_generator(seed, EMPTY, 2).below(2)]
        assert decision.chosen == expected
        assert trial.subgoals == len(expected)
        seen.add(expected)
    assert len(seen) == 2


def test_full_stops_along_a_sequence_at_the_first_unsolved_subgoal() -> None:
    # 2 x 4 with standing blocks: an odd number of rows cannot be filled.
    # rows(1): nothing legal, 0. rows(2) from nothing: 2 + 1. rows(4) from rows(2): 3 again.
    # rows(3) from rows(2): nothing legal, 0. rows(3) from nothing: 2 + 1, then it is stuck, and
    # the budget of 3 is reached. rows(4) from nothing: 2; 2; then, if the first two blocks are
    # in one column, the other is left, 1, else 2; 1.
    chosen = set()
    for seed in range(20):
        trial = planners.full(
            2, 4, full_board(2, 4), STANDING, seed, search='bfs', depth=1, lam=0.5, budget=3
        )
        draws = attempt_generator(seed, EMPTY, full_board(2, 4), 4, 0)
        whole = 6 if draws.below(2) == draws.below(2) else 7
        proven, exhausted = 'unsolvable_proven', 'budget_exhausted'
        (decision,) = trial.decisions
        assert decision.candidates == (
            planners.Candidate((1, 2, 3, 4), 8, 0, None, proven),
            planners.Candidate((1, 2, 4), 8, 0, None, proven),
            planners.Candidate((1, 3, 4), 8, 0, None, proven),
            planners.Candidate((1, 4), 8, 0, None, proven),
            planners.Candidate((2, 3, 4), 8, 3, None, proven),
            planners.Candidate((2, 4), 8, 6, 8 - 0.5 * 6, 'solved'),
            planners.Candidate((3, 4), 8, 3, None, exhausted),
            planners.Candidate((4,), 8, whole, 8 - 0.5 * whole, 'solved'),
        )
        tie = subgoal_generator(seed, EMPTY, 4).below(2)
        assert decision.chosen == ((2, 4) if whole == 7 else [(2, 4), (4,)][tie])
        assert trial.subgoal_planning_cost == 3 + 6 + 3 + whole
        assert trial.action_planning_cost == (6 if decision.chosen == (2, 4) else whole)
        assert (trial.blocks, trial.subgoals) == (4, len(decision.chosen))
        chosen.add((whole, decision.chosen))
    assert chosen == {(7, (2, 4)), (6, (2, 4)), (6, (4,))}


def test_full_gives_up() -> None:
    # The step with dominoes: (1, 2): 1, then nothing legal; (2): fails twice for 2.
    width, height, step = read_picture(STEP)
    trial = planners.full(width, height, step, DOMINOES, search='bfs', depth=1, budget=3)
    assert trial.status == 'gave_up'
    assert (trial.blocks, trial.subgoals, trial.action_planning_cost) == (0, 0, 0)
    assert trial.subgoal_planning_cost == 1 + 4
    assert trial.decisions[0].candidates == (
        planners.Candidate((1, 2), 3, 1, None, 'unsolvable_proven'),
        planners.Candidate((2,), 3, 4, None, 'budget_exhausted'),
    )


# All planners.


def test_trials_can_be_replayed() -> None:
    rng = random.Random(1893)
    statuses = set()
    for seed in range(150):
        width, height, library, silhouette, _ = random_board(rng)
        searches: list[dict[str, Any]] = [
            {'search': 'random'},
            {'search': 'bfs', 'depth': 2},
            {'search': 'astar', 'iterations': 4},
            {'search': 'best_first', 'iterations': 4},
        ]
        settings = {**rng.choice(searches), 'budget': 8}
        board = width, height, silhouette, library
        for trial in (
            planners.none(*board, EMPTY, seed, **settings),
            planners.scoping(*board, EMPTY, seed, lam=0.1, **settings),
            planners.scoping(*board, EMPTY, seed, lam=0.1, commit='action', **settings),
            planners.full(*board, seed, **settings),
        ):
            state = EMPTY
            for placement in trial.placements:
                assert placement in legal_placements(width, height, library, silhouette, state)
                state = place(state, [placement])
            assert (trial.status == 'success') == (state == silhouette)
            assert trial.blocks == len(trial.placements)
            statuses.add(trial.status)
    assert statuses == {'success', 'stuck', 'gave_up'}
