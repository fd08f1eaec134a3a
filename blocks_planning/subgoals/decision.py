"""The input and output of a subgoal planner.

A planner is a pure function of its :class:`Situation`. It returns the :class:`Query` tuples whose
results it still needs, or a :class:`Decision`. The caller has the queries solved, in any order and
in any process, and calls the planner again with the answers. So a planner or a searcher that is
restarted loses no information.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, MutableMapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar, NamedTuple, Protocol, TypeAlias

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.search.result import SolveResult, SolveStatus
from blocks_planning.subgoals.proposals import Proposal
from blocks_planning.subgoals.regions import Region


class Query(NamedTuple):
    """Can exactly ``target`` be filled from the state ``built``, and at what cost?

    ``blocks`` are those that fill ``built`` if the search plans on blocks; otherwise it is empty.
    """

    built: Mask
    target: Mask
    blocks: tuple[Placed, ...] = ()


Known: TypeAlias = Mapping[Query, SolveResult]
Chain: TypeAlias = tuple[Region, ...]
"""A sequence of regions to fill."""


@dataclass(frozen=True)
class Situation:
    """Everything that a decision depends on.

    Attributes:
        task: silhouette, board and library.
        built: the filled cells; the silhouette is not complete.
        seed: of the trial, for tie-breaking.
        known: answered queries.
        proposals: of a person in this state, in order; empty unless the strategy asks a person.
        blocks: the blocks that stand, in the order in which they landed.
        decisions: number of decisions made earlier in the trial.
        plans_on_blocks: whether the search must know the blocks that fill a state.
        weighed: what was weighed with the known answers, to be used again; see :class:`Weighed`.
    """

    task: Task
    built: Mask
    seed: int
    known: Known
    proposals: tuple[Proposal, ...] = ()
    blocks: tuple[Placed, ...] = ()
    decisions: int = 0
    plans_on_blocks: bool = False
    weighed: MutableMapping[Hashable, Weighed] = field(default_factory=dict, compare=False)

    @property
    def start(self) -> tuple[Placed, ...]:
        """The blocks of a query in this state."""
        return self.blocks if self.plans_on_blocks else ()

    def after(self, query: Query, result: SolveResult) -> tuple[Placed, ...]:
        """The blocks of a query in the state in which a solved one ends."""
        return (*query.blocks, *result.placements) if self.plans_on_blocks else ()


class Candidate(NamedTuple):
    """A considered chain of regions (a single region if scoping looks one subgoal ahead).

    Attributes:
        regions: of the chain, in order.
        cells: r, the cells that it would add.
        planning_cost: c [states], up to and including its first unsolved subgoal.
        value: V = r - lambda * c; None if a subgoal is unsolved, or the strategy does not use
            values.
        status: of its first unsolved subgoal, or solved.
        probability: of being chosen; None if the choice is not random.
    """

    regions: Chain
    cells: int
    planning_cost: int
    value: float | None
    status: SolveStatus
    probability: float | None = None

    @property
    def is_solved(self) -> bool:
        """Whether every subgoal of the chain is solved."""
        return self.status is SolveStatus.SOLVED


class Weighed(NamedTuple):
    """The chains of a state whose queries are all answered, and what they add and cost.

    This is the same for every lambda, and trials that differ in it come through the same states.

    Attributes:
        candidates: the chains, still without values.
        sequences: number of chains that exist.
    """

    candidates: tuple[Candidate, ...]
    sequences: int


@dataclass(frozen=True)
class Subgoal:
    """A region to fill next, and the result of its solve.

    Attributes:
        region: the cells to fill, with their label.
        target: all cells that are filled when the subgoal is reached.
        execute: number of placements to carry out before the next decision.
        placements: the whole plan that fills the region; if the solve failed, the last attempt.
        planning_cost: of its solve [states].
        solution_cost: of the attempt that succeeded [states]; 0 if none did.
        attempts: of its solve.
    """

    region: Region
    target: Mask
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
        candidates: all considered chains, in the order in which ties are drawn.
        chosen: index of the chosen candidate; None if the planner gives up, because no candidate
            is solved.
        subgoals: to execute, one after the other; empty if the planner gives up.
        subgoal_planning_cost: of considering all candidates [states].
        sequences: number of chains that exist; more than the candidates if they are a sample.
    """

    built: Mask
    candidates: tuple[Candidate, ...]
    chosen: int | None
    subgoals: tuple[Subgoal, ...]
    subgoal_planning_cost: int
    sequences: int


class Strategy(Protocol):
    """A subgoal planner; its fields are its settings.

    Attributes:
        asks_person: whether its candidates are the proposals of a person.
        is_external: whether another program decides.
    """

    name: ClassVar[str]
    asks_person: ClassVar[bool]
    is_external: ClassVar[bool]

    @property
    def is_blind(self) -> bool:
        """Whether a plan is executed to its end, whatever is observed meanwhile."""
        ...

    @property
    def hides_costs(self) -> bool:
        """Whether planning costs must not be shown while a trial runs."""
        ...

    def decide(self, situation: Situation) -> list[Query] | Decision:
        """Decide, or list the queries that must be answered first.

        An empty list means that another proposal of a person is needed.
        """
        ...

    def chains(self, situation: Situation) -> Sequence[Chain]:
        """The chains of a decision's candidates, in order; independent of ``situation.known``."""
        ...

    def sequences(self, situation: Situation) -> int:
        """Number of chains that exist; more than :meth:`chains` lists if those are a sample."""
        ...

    def rated(
        self, candidates: Sequence[Candidate], situation: Situation
    ) -> tuple[Candidate, ...]:
        """The candidates with their probabilities of being chosen, if the choice is random."""
        ...

    def value(self, cells: int, planning_cost: int) -> float | None:
        """V of a solved chain [cells]; None if the strategy does not use values."""
        ...

    def choose(self, candidates: Sequence[Candidate], situation: Situation) -> int | None:
        """Index of the candidate to execute; None to give up."""
        ...

    def subgoals_of(self, chain: Chain) -> Chain:
        """The regions of the chosen chain that are executed before the next decision."""
        ...

    def execute(self, plan: int) -> int:
        """Number of placements executed of a subgoal's plan of ``plan`` placements."""
        ...

    def considered(self, candidates: Sequence[Candidate]) -> int:
        """The subgoal planning cost of a decision with these candidates [states]."""
        ...
