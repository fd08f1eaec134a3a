"""Checks that every member of a family must pass, for the authors of plug-ins and our own tests.

Each function takes a class, tries it on small random towers, and raises :class:`CheckFailed` with a
sentence about the first violated rule::

    from blocks_planning.testing import check_search
    check_search(MySearch)
"""

from __future__ import annotations

import json
import random
from collections.abc import Iterator
from contextlib import nullcontext
from dataclasses import replace
from typing import Any

from blocks_planning.board import rules
from blocks_planning.board.blocks import PAPER_LIBRARY, Block, Placed, Placement
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError
from blocks_planning.search.result import CancelToken, Problem, SolveResult, SolveStatus
from blocks_planning.search.searches import BreadthFirst, Search
from blocks_planning.search.solve import solve
from blocks_planning.settings import Setting, described
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.proposals import Proposal, ProposalKind
from blocks_planning.subgoals.registry import STRATEGIES
from blocks_planning.trials.following import Shared, follow
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.reading import record_from_json
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.verify import contradictions
from blocks_planning.worlds.observation import Observation, mask_of
from blocks_planning.worlds.world import ImpossibleOrder

TOWERS = 12
"""Default number of random towers in a check."""
_BUDGET = 200


class CheckFailed(AssertionError):
    """A member of a family violates a rule that other code relies on."""


def check_search(cls: type[Any], towers: int = TOWERS, seed: int = 0) -> None:
    """Check an action-level search.

    A solve must be a pure function of its arguments, fill exactly its region with legal placements
    if it is solved, count its costs consistently, and end when it is cancelled.
    """
    search: Search = _made(cls)
    chance = random.Random(seed)
    for number in range(towers):
        task = _tower(chance)
        problem = Problem(task, 0, task.silhouette)
        first = solve(problem, search, number, _BUDGET)
        _require(first == solve(problem, search, number, _BUDGET), cls, 'is not repeatable')
        _check_result(cls, problem, first)
    used = CancelToken()
    used.cancel()
    large = Problem(*_large())
    ended = solve(large, search, 0, 1 << 40, used)
    ends_early = (SolveStatus.CANCELLED, SolveStatus.SOLVED, SolveStatus.UNSOLVABLE_PROVEN)
    _require(ended.status in ends_early, cls, 'continues after it was cancelled')


def _check_result(cls: type[Any], problem: Problem, found: SolveResult) -> None:
    built = problem.built
    for placed in found.placements:
        landed = rules.drop(problem.task.board, built, placed.placement)
        _require(landed == placed, cls, f'plans {placed}, which does not come to rest there')
        built |= rules.cells_of(problem.task.board, placed)
        _require(not built & ~problem.region, cls, f'plans {placed}, outside the region')
    _require(
        found.solved == (built == problem.region),
        cls,
        'has a status that contradicts its placements',
    )
    _require(
        found.solved or not found.placements,
        cls,
        'has placements although the problem is not solved',
    )
    costs = (found.solution_cost, found.planning_cost, found.attempts)
    _require(min(costs) >= 0, cls, 'has a negative cost')
    _require(
        found.solution_cost <= found.planning_cost,
        cls,
        'has a solution cost above the planning cost',
    )


def check_regions(cls: type[Any], towers: int = TOWERS, seed: int = 0) -> None:
    """Check a region family.

    In every state its regions must be the same when asked again, lie in the silhouette, add a
    cell, have different targets and different labels.
    """
    family = _made(cls)
    chance = random.Random(seed)
    for _ in range(towers):
        task = _tower(chance)
        for built in _states(chance, task):
            regions = family.regions(task, built)
            _require(regions == family.regions(task, built), cls, 'is not repeatable')
            targets = [region.target(built) for region in regions]
            _require(len(set(targets)) == len(targets), cls, 'lists a target twice')
            labels = [region.label for region in regions]
            _require(len(set(labels)) == len(labels), cls, 'lists a label twice')
            for region in regions:
                inside = not region.cells & ~task.silhouette
                _require(inside, cls, f'lists {region.label} with cells outside the silhouette')
                adds = region.target(built) != built
                _require(adds, cls, f'lists {region.label}, which adds no cell')


def check_strategy(cls: type[Any], towers: int = TOWERS, seed: int = 0) -> None:
    """Check a subgoal planner.

    Whole trials must give the same record with and without messages, and again when repeated;
    the record must not change when it is written and read, and verification must find nothing. A
    planner that says by its view that others list the same chains must list the same as these.
    """
    strategy = _made(cls)
    chance = random.Random(seed)
    with nullcontext() if cls.name in STRATEGIES else STRATEGIES.added(cls):
        for number in range(towers):
            task = _tower(chance)
            _check_trial(cls, TrialSpec('check', task, strategy, BreadthFirst(1), number, _BUDGET))


def _check_trial(cls: type[Any], spec: TrialSpec) -> None:
    proposals = _proposals(spec.task) if spec.strategy.asks_person else []
    record = run_trial(spec, proposals=proposals)
    _require(record == run_trial(spec, proposals=proposals), cls, 'is not repeatable')
    if not spec.strategy.asks_person:
        _require(record == follow(spec), cls, 'depends on how its queries are answered')
    if (view := getattr(spec.strategy, 'view', None)) is not None:
        shared = Shared()
        follow(replace(spec, strategy=view), shared)
        _require(record == follow(spec, shared), cls, 'lists other chains than its view')
    again = record_from_json(json.loads(record.to_line()), 'check')
    _require(again == record, cls, 'has a record that changes when it is written and read')
    for sentence in contradictions(record):
        raise CheckFailed(f'{cls.name}: verification reports: {sentence}')


def check_world(cls: type[Any], towers: int = TOWERS, seed: int = 0) -> None:
    """Check a world.

    An outcome must be a pure function of (board, order, seed, sequence), be accepted by the world
    itself, and be possible; an unsupported block must not be accepted.
    """
    world = _made(cls)
    chance = random.Random(seed)
    for number in range(towers):
        task = _tower(chance)
        if world.simulates:
            _check_outcomes(cls, world, task, number)
            spec = TrialSpec('check', task, NoSubgoals(), BreadthFirst(1), number, _BUDGET, world)
            for sentence in contradictions(run_trial(spec)):
                raise CheckFailed(f'{cls.name}: verification reports: {sentence}')
        hanging = Placed(1, 1, 0, task.board.height - 1)
        seen = Observation(Placement(Block(1, 1), 0), (hanging,))
        complaint = world.complaint(task, (), 0, seen, number, 1)
        _require(bool(complaint), cls, 'accepts a block that rests on nothing')


def _check_outcomes(cls: type[Any], world: Any, task: Task, seed: int) -> None:
    strange = Placement(Block(task.board.width + 1, 1), 0)
    try:
        world.carry_out(task, 0, strange, seed, 1)
    except ImpossibleOrder:
        pass
    else:
        raise CheckFailed(
            f'{cls.name}: carries out an order of a block that is not in the library'
        )
    for placed in rules.possible_placements(task.board, 0, task.library):
        seen = world.carry_out(task, 0, placed.placement, seed, 1)
        again = world.carry_out(task, 0, placed.placement, seed, 1)
        _require(seen == again, cls, 'is not repeatable')
        complaint = world.complaint(task, (), 0, seen, seed, 1)
        _require(not complaint, cls, f'rejects its own outcome: {complaint}')
        _require(seen.ordered == placed.placement, cls, 'has an observation without its order')


def _made(cls: type[Any]) -> Any:
    """The class with default settings; checks that each setting refuses what it must."""
    _require(bool(cls.__doc__), cls, 'has no docstring; help and errors need it')
    made = cls()
    for attribute, known in described(cls):
        _require(bool(known.text), cls, f'setting {known.name} has no line of help')
        for wrong in _wrong_values(known):
            try:
                cls(**{attribute: wrong})
            except ConfigurationError:
                continue
            raise CheckFailed(f'{cls.name}: setting {known.name} accepts {wrong!r}')
    return made


def _wrong_values(known: Setting) -> Iterator[object]:
    if known.family is not None:
        return
    yield None
    if known.kind is not str:
        yield 'word'
    if known.choices:
        yield 'no such word'
    if known.least is not None:
        yield known.kind(known.least) - 1
    if known.most is not None:
        yield known.kind(known.most) + 1


def _require(holds: bool, cls: type[Any], sentence: str) -> None:
    if not holds:
        raise CheckFailed(f'{cls.name}: {sentence}')


def _tower(chance: random.Random) -> Task:
    """A tower that can be built: made by dropping blocks."""
    board = Board(chance.randint(2, 5), chance.randint(3, 6))
    *_, built = _states(chance, Task(board, board.full, PAPER_LIBRARY), most=6)
    return Task(board, built, PAPER_LIBRARY)


def _large() -> tuple[Task, Mask, Mask]:
    board = Board(8, 8)
    return Task(board, board.full, PAPER_LIBRARY), 0, board.full


def _states(chance: random.Random, task: Task, most: int = 4) -> Iterator[Mask]:
    """States along a random sequence of legal placements, starting with the empty board."""
    built = 0
    yield built
    for _ in range(chance.randint(1, most)):
        legal = list(rules.legal_placements(task, built, task.silhouette))
        if not legal:
            return
        built |= mask_of(task.board, [chance.choice(legal)])
        yield built


def _proposals(task: Task) -> list[Proposal]:
    """A person who proposes the whole silhouette, and then gives up."""
    build = Proposal(0, 0, ProposalKind.BUILD, task.silhouette, 1.0)
    return [build, Proposal(0, 1, ProposalKind.GIVE_UP, 0, 1.0)]
