"""Impossible messages are refused, by field and value."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest
from blocks_planning_msgs import msg as ros
from carried import BOARD, BY_NAME, example, sent, set_field

from blocks_planning.board.geometry import Board
from blocks_planning.ros.wire.conversions import fields
from blocks_planning.ros.wire.conversions.cells import grid_to_ros
from blocks_planning.ros.wire.conversions.fields import MAX_COST, MessageError


def _drop_last(path: str) -> Callable[[Any], None]:
    return lambda message: set_field(path, list(getattr(message, path))[:-1])(message)


PLACED = ros.Placement(block=ros.Block(width=1, height=2), column=0, row=3)
FREE_FALL = [PLACED]
REFUSED: list[tuple[str, Callable[[Any], None], str, str]] = [
    ('trial', set_field('trial_id', ''), 'trial_id', "''"),
    *(
        (topic, set_field(f'{field}.{side}', value), f'{field}.{side}', str(value))
        for topic, field in (
            ('trial', 'silhouette'),
            ('state', 'built'),
            ('search/request', 'queries[0].target'),
            ('search/result', 'query.built'),
            ('plan', 'target'),
            ('subgoal', 'decisions[0].built'),
            ('subgoal', 'decisions[0].subgoals[0].target'),
            ('subgoal', 'decisions[0].regions[0].cells'),
        )
        for side in ('width', 'height')
        for value in (0, 17, 255)
    ),
    ('trial', set_field('silhouette.cells', b'\1\1'), 'silhouette.cells', '2'),
    ('trial', set_field('silhouette.cells', b'\2' * 24), 'silhouette.cells', '2'),
    ('state', set_field('built', grid_to_ros(Board(5, 5), 0)), 'built', '5 x 5'),
    ('trial', set_field('library', []), 'library', '0'),
    ('trial', set_field('library', [ros.Block(width=1, height=1)] * 2), 'library', '1x1'),
    ('trial', set_field('library[0].width', 0), 'library[0].width', '0'),
    ('trial', set_field('library[1].height', 17), 'library[1].height', '17'),
    ('trial', set_field('library', [ros.Block(width=1, height=1)] * 300), 'library', '300'),
    ('trial', set_field('built', FREE_FALL), 'built', 'rests on nothing'),
    ('trial', set_field('built', FREE_FALL * 300), 'built', '300'),
    ('trial', set_field('planner.strategy', 'luck'), 'planner.strategy', "'luck'"),
    ('trial', set_field('planner.search', ''), 'planner.search', "''"),
    ('trial', set_field('planner.world', 'moon'), 'planner.world', "'moon'"),
    *(
        ('trial', set_field('planner.search_settings', settings), f'planner.search{where}', value)
        for settings, where, value in (
            ([ros.Setting(name='depth', type=2)], '', 'depth must be'),
            ([ros.Setting(name='depth', type=2, integer_value=65)], '', '65'),
            ([ros.Setting(name='depth', type=4, string_value='2')], '', "'2'"),
            ([ros.Setting(name='depth', type=1, bool_value=True)], '', 'True'),
            ([ros.Setting(name='iterations', type=2)], '', "'iterations'"),
            ([ros.Setting(name='depth')], '_settings[0].type', '0'),
            ([ros.Setting(name='depth', type=9)], '_settings[0].type', '9'),
            (
                [ros.Setting(name='depth', type=2, integer_value=2)] * 2,
                '_settings[1].name',
                'once',
            ),
            ([ros.Setting(name='a', type=2)] * 65, '_settings', '65'),
        )
    ),
    *(
        (
            'trial',
            set_field('planner.strategy_settings[0].double_value', value),
            'planner.strategy: lambda',
            str(value),
        )
        for value in (float('nan'), float('inf'), -0.5)
    ),
    ('trial', set_field('planner.budget', 2**63), 'budget', str(2**63)),
    ('state', set_field('sequence', 0), 'sequence', '0'),
    ('state', set_field('status', 'cancelled'), 'status', "'cancelled'"),
    ('state', set_field('status', ''), 'status', "''"),
    ('state', _drop_last('placements'), 'placements', 'others'),
    ('state', _drop_last('observations'), 'sequence', ''),
    ('state', set_field('observations', []), 'observations', '0 entries'),
    (
        'state',
        set_field('observations[1].gone', FREE_FALL),
        'observations[1].gone',
        'was not on the board',
    ),
    ('state', set_field('observations[1].ordered_block.width', 0), 'ordered_block.width', '0'),
    ('state', set_field('observations[1].landed[0].row', 99), 'observations[1].landed[0]', '99'),
    ('state', set_field('observations[1].landed', FREE_FALL * 99), 'observations[1].landed', '99'),
    ('state', set_field('placements', FREE_FALL), 'placements', 'others'),
    ('state', set_field('placements[0].column', 200), 'placements[0]', '200'),
    ('state', set_field('placements[0].block.width', 0), 'placements[0].block.width', '0'),
    ('search/result', set_field('status', 'cancelled'), 'status', "'cancelled'"),
    ('search/result', _drop_last('placements'), 'placements', ''),
    ('search/result', set_field('placements', FREE_FALL), 'placements[0].row', '3'),
    ('search/request', set_field('queries[0].built.cells', b'\1' * 24), 'queries[0].target', ''),
    ('search/request', set_field('queries', []), 'queries', '0 entries'),
    ('plan', set_field('placements[0].row', 200), 'placements[0]', '200'),
    ('action', set_field('block.width', 0), 'block.width', '0'),
    ('action', set_field('block.height', 17), 'block.height', '17'),
    ('action/outcome', set_field('code', 0), 'code', '0'),
    ('action/outcome', set_field('code', 9), 'code', '9'),
    ('action/outcome', set_field('progress', 1.5), 'progress', '1.5'),
    ('action/outcome', set_field('progress', float('nan')), 'progress', 'nan'),
    ('action/outcome', set_field('placed.column', 9), 'placed', '9'),
    ('outcome', set_field('status', 'building'), 'status', "'building'"),
    ('outcome', set_field('status', 'refused'), 'status', "'refused'"),
    ('outcome', set_field('code', 2), 'code', '2'),
    ('subgoal/proposal', set_field('sequence', 4096), 'sequence', '4096'),
    ('subgoal/proposal', set_field('number', 1000), 'number', '1000'),
    ('subgoal/proposal', set_field('kind', 'maybe'), 'kind', "'maybe'"),
    ('subgoal/proposal', set_field('region.cells', b'\1'), 'region.cells', '1'),
    ('subgoal/proposal', set_field('region', grid_to_ros(Board(5, 5), 0)), 'region', '5 x 5'),
    *(
        ('subgoal/proposal', set_field('thinking_s', value), 'thinking_s', str(value))
        for value in (-1.0, float('nan'), float('inf'))
    ),
    ('subgoal', set_field('decisions', []), 'decisions', '0'),
    ('subgoal', set_field('status', 'none_solvable'), 'status', "'none_solvable'"),
    ('subgoal', set_field('decisions[0].chosen', -2), 'decisions[0].chosen', '-2'),
    ('subgoal', set_field('decisions[0].chosen', -1), 'decisions[0].chosen', '-1'),
    ('subgoal', set_field('decisions[0].chosen', 99), 'decisions[0].chosen', '99'),
    ('subgoal', set_field('decisions[0].executed', 0), 'decisions[0].executed', '0'),
    ('subgoal', set_field('decisions[0].executed', 2), 'decisions[0].executed', '2'),
    ('subgoal', set_field('decisions[0].candidates[0].value', float('nan')), 'value', 'nan'),
    ('subgoal', set_field('decisions[0].candidates[0].value', float('-inf')), 'value', '-inf'),
    ('subgoal', set_field('decisions[0].candidates[0].probability', 1.5), 'probability', '1.5'),
    ('subgoal', set_field('decisions[0].candidates[0].regions', []), 'regions', '0 entries'),
    ('subgoal', set_field('decisions[0].candidates[0].regions', [99]), 'regions', '99'),
    ('subgoal', set_field('decisions[0].regions[0].label_kind', ''), 'label_kind', "''"),
    ('subgoal', set_field('decisions[0].regions[0].label_kind', 'x' * 65), 'label_kind', 'xxx'),
    ('subgoal', set_field('decisions[0].regions[0].label_numbers', [1] * 17), 'numbers', '17'),
    ('subgoal', set_field('decisions[0].regions', []), 'regions', '0'),
    (
        'subgoal',
        set_field('decisions[0].candidates[0].status', 'x'),
        'candidates[0].status',
        "'x'",
    ),
    ('subgoal', set_field('decisions[0].subgoals[0].execute', 0), 'subgoals[0].execute', '0'),
    ('subgoal', set_field('decisions[0].subgoals[0].execute', 99), 'subgoals[0].execute', '99'),
    ('subgoal', set_field('decisions[0].subgoals[0].region', 99), 'subgoals[0].region', '99'),
    (
        'subgoal',
        set_field('decisions[0].subgoals[0].placements', FREE_FALL),
        '.placements[0]',
        '3',
    ),
    ('subgoal', set_field('decisions[0].subgoals[0].placements', []), '.placements', '0'),
]


@pytest.mark.parametrize(
    ('name', 'change', 'field', 'value'),
    [pytest.param(*case, id=f'{case[0]}-{case[2]}-{case[3]}') for case in REFUSED],
)
def test_what_can_not_be_is_refused_by_field_and_value(
    name: str, change: Callable[[Any], None], field: str, value: str
) -> None:
    topic = BY_NAME[name]
    message = example(topic)
    topic.from_ros(BOARD, sent(message))
    change(message)
    with pytest.raises(MessageError) as refused:
        topic.from_ros(BOARD, sent(message))
    assert field in str(refused.value)
    assert value in str(refused.value)


@pytest.mark.parametrize(
    ('name', 'path'),
    [
        ('search/result', 'planning_cost'),
        ('search/result', 'solution_cost'),
        ('subgoal', 'decisions[1].subgoal_planning_cost'),
        ('subgoal', 'decisions[0].candidates[0].planning_cost'),
        ('subgoal', 'decisions[0].subgoals[0].planning_cost'),
        ('subgoal', 'decisions[0].subgoals[0].solution_cost'),
    ],
)
def test_costs_that_no_sum_could_hold_are_refused(name: str, path: str) -> None:
    topic = BY_NAME[name]
    message = example(topic)
    set_field(path, MAX_COST)(message)
    topic.from_ros(BOARD, sent(message))
    set_field(path, 2**64 - 1)(message)
    with pytest.raises(MessageError, match=f'{re.escape(path)}.*{2**64 - 1}'):
        topic.from_ros(BOARD, sent(message))


@pytest.mark.parametrize(
    ('name', 'path', 'bound'),
    [
        ('state', 'observations', 'MOST_OBSERVATIONS'),
        ('search/request', 'queries', 'MOST_QUERIES'),
        ('subgoal', 'decisions', 'MOST_OBSERVATIONS'),
        ('subgoal', 'decisions[0].regions', 'MOST_REGIONS'),
        ('subgoal', 'decisions[0].candidates', 'MOST_CANDIDATES'),
    ],
)
def test_lists_are_bounded(name: str, path: str, bound: str) -> None:
    """Before anything in them is looked at."""
    most = getattr(fields, bound)
    message = example(BY_NAME[name])
    owner, last = _owner(message, path)
    setattr(owner, last, getattr(owner, last)[:1] * (most + 1))
    with pytest.raises(MessageError, match=f'{re.escape(path)}.*{most + 1} entries'):
        BY_NAME[name].from_ros(BOARD, message)


def _owner(message: Any, path: str) -> tuple[Any, str]:
    *owners, name = path.replace('[', '.').replace(']', '').split('.')
    for owner in owners:
        message = message[int(owner)] if owner.isdecimal() else getattr(message, owner)
    return message, name
