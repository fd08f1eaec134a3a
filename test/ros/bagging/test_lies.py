"""Lies in bags are found."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from bag_builders import SPECS, Said, changed_bag, held_complaints

from blocks_planning.ros.wire.topics import OUTCOME, STATE, SUBGOAL, TRIAL


def _as_stuck(outcome: Any) -> None:
    outcome.status = 'stuck'
    outcome.code = outcome.CODE_STUCK


LIES: dict[str, Callable[[Any], object]] = {
    'status': _as_stuck,
    'blocks': lambda outcome: setattr(outcome, 'blocks', outcome.blocks + 1),
    'subgoals': lambda outcome: setattr(outcome, 'subgoals', outcome.subgoals + 1),
    'action_planning_cost': lambda outcome: setattr(outcome, 'action_planning_cost', 1),
    'subgoal_planning_cost': lambda outcome: setattr(outcome, 'subgoal_planning_cost', 2),
    'solution_cost': lambda outcome: setattr(outcome, 'solution_cost', 3),
    'orders': lambda outcome: setattr(outcome, 'orders', outcome.orders + 1),
    'surprises': lambda outcome: setattr(outcome, 'surprises', 1),
    'f1': lambda outcome: setattr(outcome, 'f1', 0.5),
    'placements': lambda outcome: outcome.placements.reverse(),
}


@pytest.mark.parametrize('name', LIES)
def test_lie_about_the_outcome_is_found(
    name: str, tmp_path: Path, bag: Path, cli: Callable[..., Any]
) -> None:
    victim = SPECS[1].trial_id

    def lie(one: Said) -> Said:
        if one.topic is OUTCOME and one.message.trial_id == victim:
            LIES[name](one.message)
        return one

    code, out, err = cli('verify', changed_bag(bag, tmp_path / 'bag', lie))
    assert (code, err) == (1, '')
    [sentence] = [line for line in out.splitlines() if "record 2 ('chair')" in line]
    assert f'the outcome has {name} ' in sentence
    assert out.splitlines()[-1] == '1 inconsistent'


def test_cancelling_is_no_way_to_hide_success(tmp_path: Path, bag: Path) -> None:
    def lie(one: Said) -> Said:
        if one.topic is OUTCOME:
            one.message.status = 'cancelled'
            one.message.code = one.message.CODE_CANCELLED
        return one

    assert any(
        "status 'cancelled'" in s for s in held_complaints(changed_bag(bag, tmp_path / 'b', lie))
    )


def test_lie_about_a_cost_is_found(tmp_path: Path, bag: Path) -> None:
    def lie(one: Said) -> Said:
        if one.topic is SUBGOAL:
            for decision in one.message.decisions:
                decision.subgoal_planning_cost += 1
        return one

    assert held_complaints(changed_bag(bag, tmp_path / 'bag', lie))


def test_state_that_cannot_be_is_named(tmp_path: Path, bag: Path, cli: Callable[..., Any]) -> None:
    def lie(one: Said) -> Said:
        if one.topic is STATE and one.message.sequence == 2:
            one.message.placements[1].row += 1
        return one

    code, out, _ = cli('verify', changed_bag(bag, tmp_path / 'bag', lie))
    assert code == 1
    assert 'a WorldState of trial' in out
    assert 'was refused: placements[1]' in out


def test_outcome_of_nothing_is_named(tmp_path: Path, bag: Path, cli: Callable[..., Any]) -> None:
    code, out, _ = cli(
        'verify',
        changed_bag(bag, tmp_path / 'bag', lambda one: None if one.topic is TRIAL else one),
    )
    assert code == 1
    assert out.count('ended, but was never announced') == len(SPECS)
