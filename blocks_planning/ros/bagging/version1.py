"""Messages of version 1, for reading old bags.

A bag contains the definitions of its messages, so they can be decoded; this module converts such a
message to the current version. Version 1 had a field for each setting, regions that are the rows
below a height or of any other shape, and worlds that carry out every order. Its `sequence` was the
number of blocks, which is the number of the latest observation in such a world.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

from blocks_planning_msgs import msg as ros

from blocks_planning.board.geometry import Mask
from blocks_planning.families import Registry
from blocks_planning.ros.wire.conversions.cells import mask_on
from blocks_planning.ros.wire.conversions.decisions import region_to_ros
from blocks_planning.ros.wire.conversions.fields import refuse
from blocks_planning.ros.wire.conversions.proposals import read_proposal
from blocks_planning.ros.wire.conversions.settings import settings_to_ros
from blocks_planning.search.searches import SEARCHES
from blocks_planning.settings import setting_names
from blocks_planning.subgoals.proposals import Proposal, proposed_at
from blocks_planning.subgoals.regions import Region, drawn_region, rows_label
from blocks_planning.subgoals.registry import STRATEGIES
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.version1 import DIFFERENT_NOW, drawn_in

_FIELDS = {
    'lambda': 'lambda_weight',
    **{
        name: name
        for name in (
            'commit',
            'participant',
            'costs',
            'depth',
            'iterations',
            'divisor',
            'execute',
        )
    },
}
"""The field of each setting in version 1."""
_STATUSES = ('success', 'stuck', 'gave_up', 'cancelled')
"""Ends of a trial in version 1; their current codes are 1 to 4."""
_BY_USER = 'the trial was cancelled'
"""The reason of an outcome if a user cancelled the trial."""
_NEW_FIELDS = {
    'TrialSpec': 'built',
    'WorldState': 'observations',
    'TrialOutcome': 'code',
}
"""A field that the message did not have in version 1."""


def is_of_version1(kind: str, message: Any) -> bool:
    """Whether a message of a bag is of version 1."""
    if kind == 'Subgoal':
        return any(hasattr(decision, 'placed') for decision in message.decisions)
    return not hasattr(message, _NEW_FIELDS[kind])


def upgraded(kind: str, message: Any, spec: TrialSpec | None) -> Any:
    """A message of version 1, converted to the current version.

    Args:
        kind: name of its type.
        message: the decoded message.
        spec: of its trial; None for the message that announces it.

    Raises:
        MessageError: if it is impossible.
    """
    return _UPGRADES[kind](message, spec)


def _spec(message: Any, _: TrialSpec | None) -> Any:
    config = message.planner
    planner = SimpleNamespace(
        strategy=config.strategy,
        strategy_settings=_settings(STRATEGIES, config.strategy, config),
        search=config.search,
        search_settings=_settings(SEARCHES, config.search, config),
        world='simulated',
        world_settings=[],
        budget=config.budget,
    )
    return SimpleNamespace(**{**vars(message), 'planner': planner, 'built': []})


def _settings(registry: Registry, name: str, config: Any) -> list[ros.Setting]:
    """The settings of a member in version 1; none for an unknown member."""
    known = setting_names(registry[name]) if name in registry else []
    values = {key: getattr(config, field) for key, field in _FIELDS.items() if key in known}
    different = {key: value for key, value in DIFFERENT_NOW.items() if key in known}
    return settings_to_ros({**{key: _plain(value) for key, value in values.items()}, **different})


def _plain(value: Any) -> Any:
    return value.item() if hasattr(value, 'item') else value


def _state(message: Any, _: TrialSpec | None) -> Any:
    observations = [
        _observation(has_order=False, landed=[]),
        *(
            _observation(has_order=True, landed=[placed], block=placed.block, column=placed.column)
            for placed in message.placements
        ),
    ]
    return SimpleNamespace(**{**vars(message), 'observations': observations})


def _observation(*, has_order: bool, landed: list[Any], block: Any = None, column: int = 0) -> Any:
    return SimpleNamespace(
        has_order=has_order, ordered_block=block, ordered_column=column, landed=landed, gone=[]
    )


def _subgoal(message: Any, spec: TrialSpec | None) -> Any:
    assert spec is not None
    board = spec.task.board
    proposals = tuple(
        read_proposal(board, proposal, f'proposals[{index}].')
        for index, proposal in enumerate(message.proposals)
    )
    decisions = [
        _decision(spec, entry, proposals, f'decisions[{index}]')
        for index, entry in enumerate(message.decisions)
    ]
    return SimpleNamespace(**{**vars(message), 'decisions': decisions})


def _decision(spec: TrialSpec, message: Any, proposals: tuple[Proposal, ...], field: str) -> Any:
    board, built = spec.task.board, mask_on(spec.task.board, message.built, f'{field}.built')
    drawn = drawn_in(spec, built, proposed_at(proposals, message.placed))
    table: dict[Region, int] = {}

    def place_of(region: Region) -> int:
        return table.setdefault(region, len(table))

    candidates = [
        _candidate(message.candidates[index], [place_of(region) for region in regions])
        for index, regions in enumerate(_chains(spec, message, drawn, field))
    ]
    subgoals = []
    for index, planned in enumerate(message.subgoals):
        region = _region(spec, built, planned, f'{field}.subgoals[{index}]')
        subgoals.append(
            SimpleNamespace(
                **{**vars(planned), 'region': place_of(region), 'target': planned.region}
            )
        )
    return SimpleNamespace(
        **{
            **vars(message),
            'sequence': message.placed,
            'regions': [region_to_ros(board, region) for region in table],
            'candidates': candidates,
            'sequences': len(candidates),
            'subgoals': subgoals,
        }
    )


def _chains(
    spec: TrialSpec, message: Any, drawn: list[Region], field: str
) -> Iterator[list[Region]]:
    """The regions of each candidate: rows below heights, or drawn regions."""
    for index, candidate in enumerate(message.candidates):
        heights = [int(height) for height in candidate.rows]
        place = f'{field}.candidates[{index}].rows'
        if heights:
            yield [_rows(spec, height, place) for height in heights]
        elif index < len(drawn):
            yield [drawn[index]]
        else:
            raise refuse(place, heights, 'heights, or a region that a person proposed')


def _rows(spec: TrialSpec, height: int, field: str) -> Region:
    if not 1 <= height <= spec.task.board.height:
        raise refuse(field, height, f'1 to {spec.task.board.height}')
    return Region(rows_label(height), spec.task.rows(height))


def _region(spec: TrialSpec, built: Mask, planned: Any, field: str) -> Region:
    target = mask_on(spec.task.board, planned.region, f'{field}.region')
    if planned.rows:
        return Region(_rows(spec, planned.rows, f'{field}.rows').label, target)
    return drawn_region(spec.task, built, target & ~built)


def _candidate(message: Any, places: list[int]) -> Any:
    added = {'regions': places, 'has_probability': False, 'probability': 0.0}
    return SimpleNamespace(**{**vars(message), **added})


def _outcome(message: Any, _: TrialSpec | None) -> Any:
    kind = ros.TrialOutcome
    codes = {status: code for code, status in enumerate(_STATUSES, start=kind.CODE_SUCCESS)}
    code = codes.get(message.status, 0)
    if code == kind.CODE_CANCELLED and message.reason != _BY_USER:
        code = kind.CODE_FAILED
    added = {'sequence': len(message.placements), 'code': code}
    return SimpleNamespace(**{**vars(message), **added})


_UPGRADES: dict[str, Callable[[Any, TrialSpec | None], Any]] = {
    'TrialSpec': _spec,
    'WorldState': _state,
    'Subgoal': _subgoal,
    'TrialOutcome': _outcome,
}
