"""What a subgoal planner asks and answers.

A planner is a pure function of what it knows. Asked for a decision, it answers either with the
:class:`Query` tuples whose results it still lacks, or with a :class:`Decision`. Whoever drives it
has the queries solved, in any order and anywhere, and asks again with more known. So nothing is
lost when a planner, or a searcher, dies in between.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Protocol, TypeAlias

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.search.result import SolveResult, SolveStatus
from blocks_planning.subgoals.proposals import Proposal


class Query(NamedTuple):
    """Can ``region`` be filled from the state ``built``, and what does finding out cost?"""

    built: Mask
    region: Mask


Known: TypeAlias = Mapping[Query, SolveResult]


@dataclass(frozen=True)
class Candidate:
    """A sequence of subgoals that was considered (of one subgoal, when scoping).

    Attributes:
        heights: of its regions, rising; none for a region of another shape.
        cells: r, the cells that it would add.
        planning_cost: c [states], up to and including its first unsolved subgoal.
        value: V = r - lambda * c; None if a subgoal is unsolved, or nothing is weighed.
        status: of its first unsolved subgoal, or solved.
    """

    heights: tuple[int, ...]
    cells: int
    planning_cost: int
    value: float | None
    status: SolveStatus


@dataclass(frozen=True)
class Subgoal:
    """A region to fill next, and what its solve gave.

    Attributes:
        height: the region is the target rows below it; None for a region of another shape.
        region: its cells, together with what is built already.
        execute: how many of the placements to carry out before anything is decided anew.
        placements: the whole plan that fills the region.
        planning_cost: of its solve [states].
        solution_cost: of the attempt that succeeded [states].
        attempts: of its solve.
    """

    height: int | None
    region: Mask
    execute: int
    placements: tuple[Placed, ...]
    planning_cost: int
    solution_cost: int
    attempts: int


@dataclass(frozen=True)
class Decision:
    """What a planner decided in a state.

    Attributes:
        built: the state.
        candidates: all that was considered, in the order in which ties are drawn.
        chosen: index of the winner; None if no candidate is solved, and the planner gives up.
        subgoals: what to execute, one after the other; none if it gives up.
        subgoal_planning_cost: what considering everything cost [states].
    """

    built: Mask
    candidates: tuple[Candidate, ...]
    chosen: int | None
    subgoals: tuple[Subgoal, ...]
    subgoal_planning_cost: int


class Strategy(Protocol):
    """A subgoal planner; its fields are its settings."""

    name: ClassVar[str]
    asks_person: ClassVar[bool]

    def decide(
        self,
        task: Task,
        built: Mask,
        seed: int,
        known: Known,
        proposals: tuple[Proposal, ...] = (),
    ) -> list[Query] | Decision:
        """Decide in a state that is not complete, or say which queries are still unanswered.

        Args:
            task: what to build.
            built: the state.
            seed: of every tie.
            known: answered queries.
            proposals: what a person has proposed in this state; only a person's strategy looks.
        """
        ...


def subgoal_of(
    height: int | None, query: Query, result: SolveResult, execute: int | None = None
) -> Subgoal:
    """The subgoal of a solved query; all of its plan is executed unless ``execute`` says less."""
    return Subgoal(
        height=height,
        region=query.region,
        execute=len(result.placements) if execute is None else execute,
        placements=result.placements,
        planning_cost=result.planning_cost,
        solution_cost=result.solution_cost,
        attempts=result.attempts,
    )
