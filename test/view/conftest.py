"""Trials to look at."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, TypeAlias

import pytest

from blocks_planning.board.blocks import Library, parse_library
from blocks_planning.board.geometry import Board
from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.search.searches import make_search
from blocks_planning.subgoals.registry import make_strategy
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec

SMALL_BLOCKS: Library = parse_library('1x1,1x2,2x1,2x2,2x4,4x2')

SpecMaker: TypeAlias = Callable[..., TrialSpec]
Recorder: TypeAlias = Callable[[TrialSpec], TrialRecord]


@pytest.fixture(scope='session')
def tower_spec() -> SpecMaker:
    """Makes the specification of a trial on one of the 16 towers."""

    def make(
        number: int = 9,
        strategy: str = 'scoping',
        search: str = 'bfs',
        name: str | None = None,
        **settings: Any,
    ) -> TrialSpec:
        stimulus = find_stimuli(f'cogsci2021/{number}')[0]
        return TrialSpec(
            stimulus=stimulus.name if name is None else name,
            task=Task(stimulus.board, stimulus.silhouette),
            strategy=make_strategy(strategy, settings),
            search=make_search(search, {}),
            seed=1,
            budget=2_000,
        )

    return make


@pytest.fixture(scope='session')
def filled_spec() -> SpecMaker:
    """Makes the specification of a trial whose silhouette is a whole board."""

    def make(width: int, height: int, strategy: str = 'scoping') -> TrialSpec:
        board = Board(width, height)
        task = Task(board, board.full, SMALL_BLOCKS)
        return TrialSpec(
            f'{width}x{height}',
            task,
            make_strategy(strategy, {}),
            make_search('random', {}),
            seed=1,
            budget=500,
        )

    return make


@pytest.fixture(scope='session')
def recorded() -> Recorder:
    """Runs trials, each once."""
    return cache(run_trial)
