"""What is aimed at after something went wrong, on boards that are checked by hand."""

from __future__ import annotations

from builders import task

from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.subgoals.aiming import regions_to_aim_at
from blocks_planning.subgoals.regions import Rows


def aimed_at(on: Task, built: Mask, aim: str) -> list[tuple[int, Mask]]:
    """The heights of the regions, and the cells that each adds to the state."""
    regions = regions_to_aim_at(Rows(), on, built, aim)
    return [(region.label.numbers[0], region.target(built) & ~built) for region in regions]


def test_column_that_is_higher_than_a_region_can_stay_out_of_it() -> None:
    """The left column is complete. ``most`` may fill the lower row alone, ``perfect`` may not."""
    on = task('###/###')
    cells = on.board.mask
    built = cells([(0, 0), (0, 1)])
    lower, all_left = cells([(1, 0), (2, 0)]), cells([(1, 0), (2, 0), (1, 1), (2, 1)])
    assert aimed_at(on, built, 'perfect') == [(2, all_left)]
    assert aimed_at(on, built, 'most') == [(1, lower), (2, all_left)]


def test_cell_below_a_block_is_given_up() -> None:
    """A block bridges the middle of the lower row."""
    on = task('###/###')
    cells = on.board.mask
    built = cells([(0, 0), (0, 1), (1, 1)])
    assert aimed_at(on, built, 'perfect') == [(2, cells([(1, 0), (2, 0), (2, 1)]))]
    assert aimed_at(on, built, 'most') == [
        (1, cells([(2, 0)])),
        (2, cells([(2, 0), (2, 1)])),
    ]


def test_cell_outside_the_silhouette_ends_what_is_perfect_only() -> None:
    on = task('##./##.')
    cells = on.board.mask
    built = cells([(2, 0)])
    assert aimed_at(on, built, 'perfect') == []
    assert aimed_at(on, built, 'most') == [
        (1, cells([(0, 0), (1, 0)])),
        (2, cells([(0, 0), (1, 0), (0, 1), (1, 1)])),
    ]
