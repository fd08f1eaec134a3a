"""Are the candidates, the choice and the costs of a decision those of the strategy?

The strategy itself provides its chains, values and choice; this module knows no strategy by name.
"""

from __future__ import annotations

from collections.abc import Iterator

from blocks_planning.board.geometry import Mask
from blocks_planning.search.result import SolveResult, SolveStatus
from blocks_planning.subgoals.decision import Candidate, Chain, Decision, Query, Situation
from blocks_planning.subgoals.planner import cells_added, targets_along
from blocks_planning.subgoals.proposals import proposed_at
from blocks_planning.trials.record import DecisionRecord, TrialRecord
from blocks_planning.worlds.observation import Blocks, blocks_after


def situation_of(record: TrialRecord, index: int) -> Situation:
    """The situation of a decision, with the answers that the record contains."""
    entry = record.decisions[index]
    blocks: Blocks = ()
    for observation in record.observations[: entry.sequence + 1]:
        blocks = blocks_after(blocks, observation)
    return Situation(
        task=record.spec.task,
        built=entry.decision.built,
        seed=record.spec.seed,
        known=dict(_answers(entry.decision, blocks if record.spec.plans_on_blocks else None)),
        proposals=proposed_at(record.proposals, entry.sequence),
        blocks=blocks,
        decisions=index,
        plans_on_blocks=record.spec.plans_on_blocks,
    )


def _answers(decision: Decision, blocks: Blocks | None) -> Iterator[tuple[Query, SolveResult]]:
    """The answers from which the executed subgoals were made; None for no blocks in queries."""
    if decision.chosen is None or decision.chosen >= len(decision.candidates):
        return
    status = decision.candidates[decision.chosen].status
    built = decision.built
    for subgoal in decision.subgoals:
        plan, solved = subgoal.placements, status is SolveStatus.SOLVED
        yield (
            Query(built, subgoal.target, blocks or ()),
            SolveResult(
                status=status,
                placements=plan if solved else (),
                solution_cost=subgoal.solution_cost,
                planning_cost=subgoal.planning_cost,
                attempts=subgoal.attempts,
                last_attempt=() if solved else plan,
            ),
        )
        built = subgoal.target
        blocks = None if blocks is None else (*blocks, *plan)


def wrong_decision(record: TrialRecord, index: int) -> Iterator[str]:
    """The errors of a decision, apart from its execution."""
    entry = record.decisions[index]
    situation = situation_of(record, index)
    if record.spec.strategy.is_external:
        yield from _wrong_claims(record, entry)
        return
    chains = list(record.spec.strategy.chains(situation))
    considered = [candidate.regions for candidate in entry.decision.candidates]
    if considered != chains[: len(considered)] or len(considered) != len(chains):
        yield 'the candidates differ from those of the strategy'
        return
    for number, candidate in enumerate(entry.decision.candidates):
        for sentence in _wrong_candidate(record, candidate, situation):
            yield f'candidate {number}: {sentence}'
    yield from _wrong_choice(record, entry, situation)
    yield from _wrong_costs(record, entry.decision)
    yield from _wrong_ratings(record, entry.decision, situation)
    yield from _wrong_subgoals(record, entry.decision, chains)


def _wrong_claims(record: TrialRecord, entry: DecisionRecord) -> Iterator[str]:
    """The errors of a decision that another program made: of everything but its choice."""
    decision = entry.decision
    for number, candidate in enumerate(decision.candidates):
        for sentence in _wrong_result(candidate, decision.built):
            yield f'candidate {number}: {sentence}'
    yield from _wrong_indices(entry)
    yield from _wrong_costs(record, decision)
    if decision.sequences < len(decision.candidates):
        yield f'{len(decision.candidates)} candidates, but only {decision.sequences} sequences'
    if decision.chosen is None or decision.chosen >= len(decision.candidates):
        return
    chain = decision.candidates[decision.chosen].regions
    yield from _wrong_regions(decision, chain[: max(1, len(decision.subgoals))], len(chain))
    for number, subgoal in enumerate(decision.subgoals):
        if subgoal.execute > len(subgoal.placements):
            yield f'subgoal {number}: executes more placements than its plan has'


def _wrong_result(candidate: Candidate, built: Mask) -> Iterator[str]:
    cells = cells_added(candidate.regions, built)
    if candidate.cells != cells:
        yield f'expected cells {cells}, got {candidate.cells}'
    if candidate.status is SolveStatus.CANCELLED:
        yield 'its solve was cancelled, but then the trial ends without a decision'


def _wrong_candidate(
    record: TrialRecord, candidate: Candidate, situation: Situation
) -> Iterator[str]:
    yield from _wrong_result(candidate, situation.built)
    value = None
    if candidate.is_solved:
        value = record.spec.strategy.value(candidate.cells, candidate.planning_cost)
    if candidate.value != value:
        yield f'expected value {value}, got {candidate.value}'


def _wrong_indices(entry: DecisionRecord) -> Iterator[str]:
    decision = entry.decision
    if entry.executed > len(decision.subgoals):
        yield f'{entry.executed} subgoals were executed, but there are {len(decision.subgoals)}'
    if (decision.chosen is None) != (not decision.subgoals):
        yield 'the chosen candidate and the executed subgoals are inconsistent'
    if decision.chosen is not None and decision.chosen >= len(decision.candidates):
        yield (
            f'chosen index {decision.chosen} is out of range: '
            f'there are {len(decision.candidates)} candidates'
        )


def _wrong_choice(
    record: TrialRecord, entry: DecisionRecord, situation: Situation
) -> Iterator[str]:
    decision = entry.decision
    yield from _wrong_indices(entry)
    if decision.chosen is not None and decision.chosen >= len(decision.candidates):
        return
    expected = record.spec.strategy.choose(decision.candidates, situation)
    if decision.chosen != expected:
        yield f'candidate {decision.chosen} is chosen, but the strategy chooses {expected}'


def _wrong_costs(record: TrialRecord, decision: Decision) -> Iterator[str]:
    expected = record.spec.strategy.considered(decision.candidates)
    if decision.subgoal_planning_cost != expected:
        yield f'expected subgoal_planning_cost {expected}, got {decision.subgoal_planning_cost}'


def _wrong_ratings(record: TrialRecord, decision: Decision, situation: Situation) -> Iterator[str]:
    strategy = record.spec.strategy
    unrated = [candidate._replace(probability=None) for candidate in decision.candidates]
    if strategy.rated(unrated, situation) != decision.candidates:
        yield 'the probabilities of the candidates differ from those of the strategy'
    sequences = strategy.sequences(situation)
    if decision.sequences != sequences:
        yield f'expected sequences {sequences}, got {decision.sequences}'


def _wrong_subgoals(record: TrialRecord, decision: Decision, chains: list[Chain]) -> Iterator[str]:
    """Subgoals that differ from the chosen chain, or plans with inconsistent costs."""
    if decision.chosen is None or decision.chosen >= len(chains):
        return
    strategy, chain = record.spec.strategy, chains[decision.chosen]
    wrong = list(_wrong_regions(decision, strategy.subgoals_of(chain), len(chain)))
    yield from wrong
    for number, subgoal in enumerate(decision.subgoals):
        execute = strategy.execute(len(subgoal.placements))
        if not wrong and subgoal.execute != execute:
            yield f'subgoal {number}: expected execute {execute}, got {subgoal.execute}'


def _wrong_regions(decision: Decision, executed: Chain, considered: int) -> Iterator[str]:
    """Subgoals that are not those executed of a chain of ``considered`` regions, or cost more."""
    assert decision.chosen is not None
    expected = [*zip(executed, targets_along(executed, decision.built), strict=True)]
    if [(one.region, one.target) for one in decision.subgoals] != expected:
        yield 'the subgoals differ from those of the chosen candidate'
        return
    cost = sum(subgoal.planning_cost for subgoal in decision.subgoals)
    whole = len(executed) == considered
    claimed = decision.candidates[decision.chosen].planning_cost
    if (cost != claimed) if whole else (cost > claimed):
        yield 'the costs of the subgoals do not add up to that of the chosen candidate'
    for number, subgoal in enumerate(decision.subgoals):
        if subgoal.solution_cost > subgoal.planning_cost:
            yield f'subgoal {number}: solution_cost is above planning_cost'
        if subgoal.attempts < 1:
            yield f'subgoal {number}: it is solved without an attempt'
