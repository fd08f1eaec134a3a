"""Every registered member passes the public checks, and the checks find what is broken."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import pytest

from blocks_planning import testing
from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.search.result import CancelToken, Problem, SolveResult
from blocks_planning.search.searches import SEARCHES, BreadthFirst
from blocks_planning.settings import setting
from blocks_planning.subgoals.regions import REGIONS, Region, Rows
from blocks_planning.subgoals.registry import STRATEGIES
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.worlds.observation import Observation
from blocks_planning.worlds.world import WORLDS, Simulated

Check = Callable[[type[Any]], None]
CHECKS: dict[str, tuple[Any, Check]] = {
    'search': (SEARCHES, testing.check_search),
    'regions': (REGIONS, testing.check_regions),
    'strategy': (STRATEGIES, testing.check_strategy),
    'world': (WORLDS, testing.check_world),
}
MEMBERS = [
    (family, name)
    for family, (registry, _) in CHECKS.items()
    for name, cls in registry.items()
    if not cls.is_external
]


@pytest.mark.parametrize(('family', 'name'), MEMBERS)
def test_every_member_passes(family: str, name: str) -> None:
    registry, check = CHECKS[family]
    check(registry[name])


@dataclass(frozen=True)
class Forgetful(BreadthFirst):
    """Gives another answer each time."""

    name: ClassVar[str] = 'forgetful'
    calls: ClassVar[list[int]] = []

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        self.calls.append(1)
        return super().run(problem, seed + len(self.calls), budget, cancel)


@dataclass(frozen=True)
class Boastful(BreadthFirst):
    """Leaves out the last placement."""

    name: ClassVar[str] = 'boastful'

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        found = super().run(problem, seed, budget, cancel)
        return replace(found, placements=found.placements[:-1])


@dataclass(frozen=True)
class Thrifty(BreadthFirst):
    """Forgets the cost of failed attempts, and a state of the last one."""

    name: ClassVar[str] = 'thrifty'

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        found = super().run(problem, seed, budget, cancel)
        return replace(found, planning_cost=max(0, found.solution_cost - 1))


@dataclass(frozen=True)
class Deaf(BreadthFirst):
    """Ignores the token."""

    name: ClassVar[str] = 'deaf'

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        return super().run(problem, seed, min(budget, 1), CancelToken())


@dataclass(frozen=True)
class Repeating(Rows):
    """Lists each region twice."""

    name: ClassVar[str] = 'repeating'

    def regions(self, task: Task, built: Mask, partial: bool = False) -> list[Region]:
        return super().regions(task, built, partial) * 2


@dataclass(frozen=True)
class Whole(Rows):
    """Lists the silhouette even where it is built."""

    name: ClassVar[str] = 'whole'

    def regions(self, task: Task, built: Mask, partial: bool = False) -> list[Region]:
        return [Region(super().regions(task, 0, partial)[0].label, built & task.silhouette)]


@dataclass(frozen=True)
class Wayward(Scoping):
    """Chooses by the number of calls."""

    name: ClassVar[str] = 'wayward'
    calls: ClassVar[list[int]] = []

    def choose(self, candidates: Any, situation: Any) -> int | None:
        self.calls.append(1)
        solved = [i for i, one in enumerate(candidates) if one.is_solved]
        return solved[len(self.calls) % len(solved)] if solved else None


@dataclass(frozen=True)
class Generous(Scoping):
    """Does not count what it considered."""

    name: ClassVar[str] = 'generous'
    calls: ClassVar[list[int]] = []

    def considered(self, candidates: Any) -> int:
        self.calls.append(1)
        return super().considered(candidates) + len(self.calls)


@dataclass(frozen=True)
class Thinning(Scoping):
    """Leaves out regions where states cost something, and does not tell by its view."""

    name: ClassVar[str] = 'thinning'

    def chains(self, situation: Any) -> Any:
        return super().chains(situation)[-1:] if self.lam else super().chains(situation)


@dataclass(frozen=True)
class Careless(BreadthFirst):
    """Has a setting without help."""

    name: ClassVar[str] = 'careless'
    width: int = setting(1, '', least=1)


@dataclass(frozen=True)
class Moody(Simulated):
    """Loses every second block that it is asked for."""

    name: ClassVar[str] = 'moody'
    calls: ClassVar[list[int]] = []

    def carry_out(self, *arguments: Any) -> Observation:
        self.calls.append(1)
        seen = super().carry_out(*arguments)
        return seen if len(self.calls) % 2 else seen._replace(landed=())


@dataclass(frozen=True)
class Credulous(Simulated):
    """Believes everything."""

    name: ClassVar[str] = 'credulous'

    def complaint(self, *arguments: Any) -> str:
        return ''


@pytest.mark.parametrize(
    ('check', 'cls', 'sentence'),
    [
        (testing.check_search, Forgetful, 'is not repeatable'),
        (testing.check_search, Boastful, 'has a status that contradicts'),
        (testing.check_search, Thrifty, 'has a solution cost above the planning cost'),
        (testing.check_search, Deaf, 'continues after it was cancelled'),
        (testing.check_search, Careless, 'setting width has no line of help'),
        (testing.check_regions, Repeating, 'lists a target twice'),
        (testing.check_regions, Whole, 'adds no cell'),
        (testing.check_strategy, Wayward, 'wayward: '),
        (testing.check_strategy, Generous, 'generous: '),
        (testing.check_strategy, Thinning, 'lists other chains than its view'),
        (testing.check_world, Moody, 'is not repeatable'),
        (testing.check_world, Credulous, 'accepts a block that rests on nothing'),
    ],
)
def test_what_is_broken_is_found(check: Check, cls: type[Any], sentence: str) -> None:
    with pytest.raises(testing.CheckFailed, match=sentence):
        check(cls)
