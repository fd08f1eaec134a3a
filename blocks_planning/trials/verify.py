"""Holding a record against the rules: its placements are replayed, its decisions recomputed."""

from __future__ import annotations

from collections.abc import Iterator

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Board, Mask, area
from blocks_planning.search.result import SolveStatus
from blocks_planning.subgoals.choosing import best, value_of
from blocks_planning.subgoals.decision import Candidate, Subgoal
from blocks_planning.subgoals.full import rising_sequences
from blocks_planning.subgoals.human import Human
from blocks_planning.subgoals.proposals import ProposalKind, decisive, proposed_at, target_of
from blocks_planning.subgoals.regions import Region, height_of, regions_above
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.record import DecisionRecord, TrialRecord
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.world import status_of


def contradictions(record: TrialRecord) -> Iterator[str]:
    """Everything in a record that does not follow from the rest, a sentence each.

    No search is run; see :func:`differs_from_rerun` for what that would show.
    """
    task = record.spec.task
    for index, placed in enumerate(record.placements):
        if placed.placement.block not in task.library:
            yield f'placement {index} ({placed}) is of a block that is not in the library'
            return
    states = _replayed(task.board, 0, record.placements)
    if len(states) <= len(record.placements):
        index = len(states) - 1
        yield f'placement {index} ({record.placements[index]}) is not where the block comes to rest'
        return
    yield from _wrong_status(record, states[-1])
    for index, entry in enumerate(record.decisions):
        for sentence in _wrong_decision(record, entry, states):
            yield f'decision {index}: {sentence}'
    if record.proposals or isinstance(record.spec.strategy, Human):
        yield from _wrong_proposals(record)
    yield from _gaps(record)


def _replayed(board: Board, built: Mask, placements: tuple[Placed, ...]) -> list[Mask]:
    """The states on a way, the first included, up to where a block would not come to rest."""
    states = [built]
    for placed in placements:
        if min(placed[:2]) < 1 or rules.drop(board, states[-1], placed.placement) != placed:
            break
        states.append(states[-1] | rules.cells_of(board, placed))
    return states


def _wrong_status(record: TrialRecord, built: Mask) -> Iterator[str]:
    reached = status_of(record.spec.task, built)
    over = reached is not TrialStatus.BUILDING
    gave_up = bool(record.decisions) and record.decisions[-1].decision.chosen is None
    # Whoever writes down that a trial was cancelled has not seen it end; at the beginning it may
    # have been over.
    may_be_cancelled = not gave_up and (not over or not record.placements)
    if record.status is TrialStatus.CANCELLED and may_be_cancelled:
        return
    expected = reached if over else TrialStatus.GAVE_UP
    if record.status is not expected or (gave_up and over) or not (gave_up or over):
        yield (
            f'status {record.status.value!r}, but the placements lead to {reached.value!r} and '
            f'the planner {"gave up" if gave_up else "did not give up"}'
        )


def _gaps(record: TrialRecord) -> Iterator[str]:
    """Placements that no decision, or more than one, asked for."""
    placed = 0
    for index, entry in enumerate(record.decisions):
        if entry.placed != placed:
            yield f'decision {index}: comes after {entry.placed} placements, not {placed}'
            return
        if entry.decision.chosen is None and index < len(record.decisions) - 1:
            yield f'decision {index}: gives up, but is not the last'
            return
        placed += sum(part.execute for part in entry.decision.subgoals[: entry.executed])
        begun = entry.executed == len(entry.decision.subgoals)
        if not begun and record.status is not TrialStatus.CANCELLED:
            yield f'decision {index}: {entry.executed} of its subgoals were executed'
            return
    left = len(record.placements) - placed
    if left > 0 or (left < 0 and record.status is not TrialStatus.CANCELLED):
        yield f'decisions lead to {placed} placements, not {len(record.placements)}'


def _wrong_decision(
    record: TrialRecord, entry: DecisionRecord, states: list[Mask]
) -> Iterator[str]:
    decision = entry.decision
    if entry.placed >= len(states) or states[entry.placed] != decision.built:
        yield f'the state after {entry.placed} placements is not {decision.built:#x}'
        return
    expected = _considered(record, entry)
    if [candidate.heights for candidate in decision.candidates] != [
        tuple(region.height for region in regions if region.height) for regions in expected
    ]:
        yield 'its candidates are not those of the strategy'
        return
    for index, candidate in enumerate(decision.candidates):
        cells = area(expected[index][-1].cells) - area(decision.built)
        for sentence in _wrong_candidate(record, candidate, cells):
            yield f'candidate {index}: {sentence}'
    yield from _wrong_choice(record, entry)
    yield from _wrong_cost(record, entry)
    yield from _wrong_way(record, entry, states, expected)


def _considered(record: TrialRecord, entry: DecisionRecord) -> list[tuple[Region, ...]]:
    """The regions of all candidates that the strategy has in a state, in order.

    A region that is not the rows below a height has height 0.
    """
    task, built = record.spec.task, entry.decision.built
    regions = regions_above(task, built)
    match record.spec.strategy.name:
        case 'none':
            return [(region,) for region in regions[-1:]]
        case 'scoping':
            return [(region,) for region in regions]
        case 'human':
            said = decisive(task, built, proposed_at(record.proposals, entry.placed))
            targets = [
                target_of(task, built, proposal.region)
                for proposal in said
                if proposal.kind is ProposalKind.BUILD
            ]
            return [(Region(height_of(task, target) or 0, target),) for target in targets]
    return list(rising_sequences(regions))


def _wrong_proposals(record: TrialRecord) -> Iterator[str]:
    """Proposals that do not lead to the decisions, one by one."""
    left = list(record.proposals)
    for index, entry in enumerate(record.decisions):
        here = proposed_at(record.proposals, entry.placed)
        numbers = [proposal.number for proposal in here]
        asking = list(decisive(record.spec.task, entry.decision.built, here))
        gave_up = bool(asking) and asking[-1].kind is ProposalKind.GIVE_UP
        decides = bool(asking) and asking[-1] == here[-1]
        if numbers != list(range(len(here))) or left[: len(here)] != list(here):
            yield f'decision {index}: its proposals are not in order'
        elif not decides or gave_up != (entry.decision.chosen is None):
            yield f'decision {index}: its last proposal does not lead to it'
        left = left[len(here) :]
    if left:
        yield f'{len(left)} proposals belong to no decision'


def _wrong_candidate(record: TrialRecord, candidate: Candidate, cells: int) -> Iterator[str]:
    if candidate.cells != cells:
        yield f'adds {cells} cells, not {candidate.cells}'
    if candidate.status is SolveStatus.CANCELLED:
        yield 'was cancelled, which ends a trial before it decides'
    lam = record.spec.to_json()['lambda']
    weighed = lam is not None and candidate.status is SolveStatus.SOLVED
    value = value_of(candidate.cells, candidate.planning_cost, lam) if weighed else None
    if candidate.value != value:
        yield f'has value {value}, not {candidate.value}'


def _wrong_choice(record: TrialRecord, entry: DecisionRecord) -> Iterator[str]:
    decision = entry.decision
    solved = [c for c in decision.candidates if c.status is SolveStatus.SOLVED]
    if (decision.chosen is None) != (not decision.subgoals) or (
        decision.chosen is None and solved
    ):
        yield 'what is chosen, solved and executed does not fit together'
    if entry.executed > len(decision.subgoals):
        yield f'{entry.executed} of {len(decision.subgoals)} subgoals cannot have been executed'
    if decision.chosen is None:
        return
    if decision.chosen >= len(decision.candidates):
        yield f'candidate {decision.chosen} is not there to be chosen'
        return
    chosen = decision.candidates[decision.chosen]
    drawn = best(decision.candidates, record.spec.seed, decision.built)
    if chosen not in solved or drawn not in (None, decision.chosen):
        yield f'candidate {decision.chosen} is not the best, or not the one that the seed draws'
    if chosen.planning_cost != sum(subgoal.planning_cost for subgoal in decision.subgoals):
        yield 'the costs of its subgoals do not add up to that of the chosen candidate'
    if chosen.heights != tuple(s.height for s in decision.subgoals if s.height is not None):
        yield 'its subgoals are not those of the chosen candidate'


def _wrong_cost(record: TrialRecord, entry: DecisionRecord) -> Iterator[str]:
    decision = entry.decision
    costs = sum(candidate.planning_cost for candidate in decision.candidates)
    expected = 0 if record.spec.strategy.name == 'none' else costs
    if decision.subgoal_planning_cost != expected:
        yield f'considering cost {expected} states, not {decision.subgoal_planning_cost}'


def _wrong_way(
    record: TrialRecord,
    entry: DecisionRecord,
    states: list[Mask],
    considered: list[tuple[Region, ...]],
) -> Iterator[str]:
    """Subgoals whose plan does not fill them, or that were not executed as planned."""
    task = record.spec.task
    built, placed = entry.decision.built, entry.placed
    chosen = entry.decision.chosen
    regions = considered[chosen] if chosen is not None and chosen < len(considered) else ()
    for index, subgoal in enumerate(entry.decision.subgoals):
        way = _replayed(task.board, built, subgoal.placements)
        fills = len(way) == len(subgoal.placements) + 1 and way[-1] == subgoal.region
        meant = regions[index].cells if index < len(regions) else None
        if not fills or subgoal.region != meant:
            yield f'subgoal {index}: its plan does not fill it'
            return
        yield from (f'subgoal {index}: {said}' for said in _wrong_subgoal(record, subgoal))
        followed = states[placed : placed + subgoal.execute + 1]
        steps = subgoal.execute + 1
        if record.status is TrialStatus.CANCELLED:
            steps = min(steps, len(followed))
        if index < entry.executed and followed != way[:steps]:
            yield f'subgoal {index}: was not executed as planned'
            return
        built, placed = subgoal.region, placed + subgoal.execute


def _wrong_subgoal(record: TrialRecord, subgoal: Subgoal) -> Iterator[str]:
    whole = record.spec.to_json()['commit'] != 'action'
    execute = len(subgoal.placements) if whole else min(1, len(subgoal.placements))
    if subgoal.execute != execute:
        yield f'{execute} of its placements are to be executed, not {subgoal.execute}'
    if subgoal.solution_cost > subgoal.planning_cost:
        yield 'its solution cost more than all attempts'
    if subgoal.attempts < 1:
        yield 'is solved without an attempt'


def differs_from_rerun(record: TrialRecord) -> Iterator[str]:
    """What is different when the trial is run again from its specification."""
    if record.status is TrialStatus.CANCELLED:
        return
    again = run_trial(record.spec, proposals=record.proposals).to_json()
    for key, value in record.to_json().items():
        if again[key] != value:
            yield f'run again, {key} is not the same'
