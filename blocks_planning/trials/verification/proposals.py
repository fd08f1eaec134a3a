"""Do the proposals of a person lead to the decisions?"""

from __future__ import annotations

from collections.abc import Iterator

from blocks_planning.subgoals.proposals import ProposalKind, decisive, proposed_at
from blocks_planning.trials.record import TrialRecord


def wrong_proposals(record: TrialRecord) -> Iterator[str]:
    """Proposals that do not fit the decisions."""
    if not record.proposals and not record.spec.strategy.asks_person:
        return
    left = list(record.proposals)
    for index, entry in enumerate(record.decisions):
        here = proposed_at(record.proposals, entry.sequence)
        numbers = [proposal.number for proposal in here]
        asking = list(decisive(record.spec.task, entry.decision.built, here))
        gave_up = bool(asking) and asking[-1].kind is ProposalKind.GIVE_UP
        decides = bool(asking) and asking[-1] == here[-1]
        if numbers != list(range(len(here))) or left[: len(here)] != list(here):
            yield f'decision {index}: the proposals are not in order'
        elif not decides or gave_up != (entry.decision.chosen is None):
            yield f'decision {index}: the last proposal does not lead to the decision'
        left = left[len(here) :]
    if left:
        yield f'{len(left)} proposals belong to no decision'
