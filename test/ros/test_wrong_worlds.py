"""Whatever a world does, its trial ends, with a code and a sentence.

The bounds are those of the defaults; the clock of the orchestrator is put forward.
"""

from __future__ import annotations

import re
import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from builders import SQUARE, spec
from carried import sent
from drivers import Act, Driver, obey
from peers import Graph
from rclpy.parameter import Parameter

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed
from blocks_planning.ros.nodes import subgoal_selector
from blocks_planning.ros.nodes.action_searcher import ActionSearcher
from blocks_planning.ros.nodes.trial_orchestrator import TrialOrchestrator
from blocks_planning.ros.runtime import patience
from blocks_planning.ros.wire.topics import STATE
from blocks_planning.trials.messages import PlaceBlock, PlacementCode, TrialEnded, observed
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions
from blocks_planning.trials.world import TOO_MANY
from blocks_planning.worlds.observation import Observation
from blocks_planning.worlds.world import Observed

SPEC = replace(spec(SQUARE, lam=0.01, depth=2), world=Observed())
BOUND_S = 30.0
RETRIES = 2
NODES = ['driver', 'subgoal_selector', 'action_searcher']
FAST = [Parameter('remind_period_s', value=0.1)]


class Orchestrator(TrialOrchestrator):
    """With a clock that can be put forward."""

    later_s = 0.0

    @property
    def now_s(self) -> float:
        """What the clock says [s]."""
        return super().now_s + self.later_s

    @property
    def waits_since(self) -> float | None:
        """When what the world owes became due [s]; None if it owes nothing."""
        return self._patience._since


class Trial:
    """A trial in a graph whose world is a driver."""

    def __init__(
        self,
        graph: Graph,
        folder: Path,
        act: Act,
        driver: Any = Driver,
        retries: int = RETRIES,
    ) -> None:
        self.graph = graph
        graph.add(subgoal_selector.make_node, parameter_overrides=FAST)
        graph.add(ActionSearcher, parameter_overrides=FAST)
        values = {'out_dir': str(folder), 'wait_for': NODES, 'retries': retries}
        overrides = [*FAST, *(Parameter(name, value=value) for name, value in values.items())]
        self.node = graph.add(
            lambda **options: Orchestrator(
                threading.Event(), parameter_overrides=overrides, **options
            )
        )
        self.world = graph.add(driver, SPEC, act)
        graph.spin_until(lambda: not self.node.peers.missing(NODES))
        self.node.start_trial(SPEC.trial_id, SPEC)

    def ended(self) -> TrialEnded:
        """The end of the trial; the record holds."""
        self.graph.spin_until(lambda: self.world.ended)
        assert list(contradictions(self.node.memory.record())) == []
        ended = self.world.ended
        assert isinstance(ended, TrialEnded)
        return ended

    def ended_by_silence(self) -> TrialEnded:
        """The end when the bound has passed after the world stopped to answer; not before."""
        self.graph.spin_until(lambda: self.world.is_stuck and self.node.waits_since)
        self.node.later_s += BOUND_S - 20
        self.node._look()
        assert self.world.ended is None
        self.node.later_s += 21
        self.node._look()
        return self.ended()


# Worlds that owe an answer


def nothing(driver: Driver, order: PlaceBlock) -> None:
    """Carry out nothing, and say nothing."""
    driver.is_stuck = True


def only_says_placed(driver: Driver, order: PlaceBlock) -> None:
    """Say that the block was placed; there is no state that shows it."""
    driver.tell(order, PlacementCode.PLACED, placed=driver.landing(order))
    driver.is_stuck = True


class Silent(Driver):
    """Does not even say which board it finds."""

    def observe(self, *observations: Observation) -> None:
        """Say nothing."""
        self.is_stuck = True


SILENT_WORLDS = {
    'an order': (nothing, Driver, 'in column 0'),
    'an order that it says is done': (only_says_placed, Driver, 'in column 0'),
    'a trial': (obey, Silent, 'after the trial was announced'),
}


@pytest.mark.parametrize('owed', SILENT_WORLDS)
def test_trial_ends_if_its_world_never_answers(graph: Graph, tmp_path: Path, owed: str) -> None:
    act, driver, what = SILENT_WORLDS[owed]
    ended = Trial(graph, tmp_path, act, driver).ended_by_silence()
    assert ended.status is TrialStatus.CANCELLED
    assert re.fullmatch(rf'the world has been silent for [3-9]\d\.\d s .*{what}', ended.reason)


def shows(wrong: Placed, shift: int = 0) -> Act:
    """A block where it cannot be, ``shift`` columns further to the right in the message."""

    def act(driver: Driver, order: PlaceBlock) -> None:
        there = Observation(landed=(wrong,))
        board, state = driver.spec.task.board, driver.state
        seen = (*driver.seen, there)
        message = sent(STATE.to_ros(board, observed(state.trial_id, board, seen, state.status)))
        message.observations[-1].landed[0].column += shift
        driver.repeat(message)

    return lambda driver, order: (act if driver.state.placements else obey)(driver, order)


IMPOSSIBLE_STATES = {
    'floating': (shows(Placed(1, 1, 3, 3)), '1x1 in column 3 and row 3 rests on nothing'),
    'overlapping': (shows(Placed(1, 2, 0, 0)), '1x2 in column 0 and row 0 overlaps another'),
    'outside': (
        shows(Placed(1, 2, 3, 0), 200),
        'expected a place on the board for a block of 1x2',
    ),
}


@pytest.mark.parametrize('name', IMPOSSIBLE_STATES)
def test_trial_ends_if_its_world_shows_what_cannot_be(
    graph: Graph, tmp_path: Path, name: str
) -> None:
    act, why = IMPOSSIBLE_STATES[name]
    trial = Trial(graph, tmp_path, act)
    graph.spin_until(lambda: trial.node.refused)
    ended = trial.ended_by_silence()
    assert ended.status is TrialStatus.CANCELLED
    assert '; its last state was refused: ' in ended.reason
    assert why in ended.reason


def test_world_may_take_its_time_if_it_says_so(graph: Graph, tmp_path: Path) -> None:
    trial = Trial(graph, tmp_path, nothing)
    node, world = trial.node, trial.world
    graph.spin_until(lambda: world.is_stuck and node.waits_since)
    (order,) = set(world.only(PlaceBlock))
    for progress in (0.3, 0.6, 0.9):
        node.later_s += BOUND_S - 10
        since = node.now_s - 1
        world.tell(order, PlacementCode.IN_PROGRESS, progress=progress)
        graph.spin_until(lambda: (node.waits_since or 0.0) > since)  # noqa: B023
        node._look()
    world.act = obey
    obey(world, order)
    assert trial.ended().status is TrialStatus.SUCCESS


# Worlds that answer, and yet the trial cannot go on


def answers(code: PlacementCode) -> Act:
    """An order is answered, and nothing else happens."""
    return lambda driver, order: driver.tell(order, code)


def goes_back(driver: Driver, order: PlaceBlock) -> None:
    """After each placement, the board is as it was found."""
    found = STATE.to_ros(driver.spec.task.board, driver.state)
    obey(driver, order)
    driver.seen = driver.seen[:1]
    driver.repeat(found)


ENDLESS = {
    'impossible': (answers(PlacementCode.IMPOSSIBLE), 'would not come to rest inside the board'),
    'try again': (answers(PlacementCode.TRY_AGAIN), '3 times; the last answer: the order cannot'),
    'failed': (answers(PlacementCode.FAILED), 'no block can be placed any more'),
    'goes back': (goes_back, 'the world went back to an earlier state 3 times'),
}


@pytest.mark.parametrize('name', ENDLESS)
def test_trial_ends_if_its_world_does_not_get_on(graph: Graph, tmp_path: Path, name: str) -> None:
    act, reason = ENDLESS[name]
    ended = Trial(graph, tmp_path, act).ended()
    assert ended.status is TrialStatus.CANCELLED
    assert reason in ended.reason


def empties(driver: Driver, order: PlaceBlock) -> None:
    """What was placed is taken away."""
    obey(driver, order)
    driver.observe(Observation(gone=driver.state.placements))


def test_trial_ends_if_its_board_is_emptied_for_ever(
    graph: Graph, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(patience, 'MAX_OBSERVATIONS', 20)
    trial = Trial(graph, tmp_path, empties)
    assert (trial.ended().status, trial.ended().reason) == (TrialStatus.CANCELLED, TOO_MANY)
    assert 19 <= len(trial.node.memory.record().observations) <= 21


# Worlds with which the trial goes on


def twice(driver: Driver, order: PlaceBlock) -> None:
    """Everything is said twice."""
    obey(driver, order)
    driver.tell(order, PlacementCode.PLACED, placed=driver.seen[-1].landed[0])
    driver.say(driver.state)


def test_world_that_answers_twice_changes_nothing(graph: Graph, tmp_path: Path) -> None:
    trial = Trial(graph, tmp_path, twice)
    assert trial.ended().status is TrialStatus.SUCCESS
    assert all(seen.is_as_ordered for seen in trial.world.seen[1:])


def places_twice(driver: Driver, order: PlaceBlock) -> None:
    """As long as that is possible, each block is placed twice."""
    obey(driver, order)
    again = rules.drop(driver.spec.task.board, driver.state.built, order.placement)
    if again is not None:
        driver.observe(Observation(order.placement, (again,)))


def test_world_that_places_each_block_twice_is_believed(graph: Graph, tmp_path: Path) -> None:
    trial = Trial(graph, tmp_path, places_twice)
    assert trial.ended().status in (TrialStatus.SUCCESS, TrialStatus.GAVE_UP)
    assert len(trial.world.seen) > 2


def is_emptied_once(driver: Driver, order: PlaceBlock) -> None:
    """Somebody takes the first block away."""
    driver.act = obey
    empties(driver, order)


def is_set_back_once(driver: Driver, order: PlaceBlock) -> None:
    """The world forgets its first placement, as one that was started anew."""
    driver.act = obey
    goes_back(driver, order)


@pytest.mark.parametrize('act', [is_emptied_once, is_set_back_once])
def test_board_that_is_changed_once_is_built_anew(graph: Graph, tmp_path: Path, act: Act) -> None:
    trial = Trial(graph, tmp_path, act, retries=50)  # nodes hear of it at different times
    assert trial.ended().status is TrialStatus.SUCCESS
