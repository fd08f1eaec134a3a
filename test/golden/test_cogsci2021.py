"""Numbers of the 16 towers that must never change."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.search.compiled import count_nodes
from blocks_planning.search.exact import analyse
from blocks_planning.search.result import CancelToken
from blocks_planning.search.searches import BreadthFirst
from blocks_planning.subgoals.full import FullSubgoals
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

GOLDEN: dict[int, Any] = yaml.safe_load(
    (Path(__file__).parent / 'cogsci2021.yaml').read_text(encoding='utf-8')
)


def tower(number: int) -> Task:
    (stimulus,) = find_stimuli(f'cogsci2021/{number}')
    return Task(stimulus.board, stimulus.silhouette)


@pytest.mark.parametrize('number', GOLDEN)
def test_states_evaluated_by_depth(number: int) -> None:
    assert count_nodes(tower(number), 4, CancelToken()) == GOLDEN[number]['counts']


@pytest.mark.parametrize('number', GOLDEN)
def test_exact_answers(number: int) -> None:
    answer = analyse(tower(number))
    assert answer is not None
    assert answer.arrangements == GOLDEN[number]['arrangements']
    assert list(answer.by_rows) == GOLDEN[number]['by_rows']
    assert answer.fewest_blocks == GOLDEN[number]['by_rows'][-1] == len(answer.placements or ())


@pytest.mark.parametrize('number', range(1, 17))
def test_full_planning_rebuilds_every_tower_with_every_seed(number: int) -> None:
    for seed in range(32):
        spec = TrialSpec(
            f'cogsci2021/{number}', tower(number), FullSubgoals(), BreadthFirst(), seed
        )
        assert run_trial(spec).status is TrialStatus.SUCCESS
