"""Compile every kernel once, before the processes of the tests need the same ones at a time."""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor

from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.search.compiled import count_nodes
from blocks_planning.search.counting import count_task
from blocks_planning.search.policy import analyse_policy
from blocks_planning.search.result import CancelToken, Problem
from blocks_planning.search.searches import SEARCHES, BreadthFirst, RandomPlacement
from blocks_planning.search.slipping import analyse_slips
from blocks_planning.search.warming import compile_for


def compile_all(side: int) -> None:
    """Compile what is run on boards of a size."""
    board = Board(side, side)
    task = Task(board, board.rectangle(0, 0, 2, 2))
    problem = Problem(task, 0, task.silhouette)
    for search in SEARCHES.values():
        compile_for(search(), board)
    count_task(task)
    count_nodes(task, 2, CancelToken())
    analyse_slips(problem, [0.1])
    for policy in (BreadthFirst(), RandomPlacement()):
        analyse_policy(problem, policy)


if __name__ == '__main__':
    with ProcessPoolExecutor(2) as pool:
        list(pool.map(compile_all, (8, 16)))
