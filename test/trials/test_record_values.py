"""Values that no record can have are refused by name."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from sample_record import (
    CANDIDATE,
    COUNTS,
    DECISION,
    REGION,
    SUBGOAL,
    Keys,
    changed,
    name_of,
    refused,
)


def test_place_is_named_once(tmp_path: Path) -> None:
    for path in (('silhouette', 1), ('library',), ('width',)):
        message = refused(tmp_path, json.dumps(changed(path, '?')))
        assert str(tmp_path) not in message


@pytest.mark.parametrize(
    'number',
    ['NaN', 'Infinity', '-Infinity', '1e400', '-1e400', '1' * 5000, f'-{"1" * 4000}', '1' * 4000],
    ids=lambda number: number[:8],
)
@pytest.mark.parametrize(
    ('path', 'key'),
    [
        *COUNTS,
        (('strategy_settings',), 'lambda'),
        (CANDIDATE, 'value'),
        (('search_settings',), 'depth'),
    ],
    ids=name_of,
)
def test_number_that_is_none_of_ours_is_refused(
    tmp_path: Path, path: Keys, key: str, number: str
) -> None:
    text = json.dumps(changed((*path, key), 'HERE')).replace('"HERE"', number)
    refused(tmp_path, text)


@pytest.mark.parametrize(
    ('path', 'value', 'words'),
    [
        pytest.param(('format',), 'other', 'expected format', id='format'),
        pytest.param(('version',), 3, 'version 1 or 2', id='version'),
        pytest.param(('version',), '1', 'version', id='version as text'),
        pytest.param(('version',), True, 'version', id='version as a bool'),
        pytest.param(('trial_id',), '0' * 16, 'trial_id', id='trial id'),
        pytest.param(('trial_id',), 'x', 'trial_id', id='no trial id'),
        pytest.param(('stimulus',), 'other', 'trial_id', id='another stimulus'),
        pytest.param(('seed',), 1, 'trial_id', id='another seed'),
        pytest.param(('seed',), -1, 'seed must be', id='negative seed'),
        pytest.param(('seed',), 2**64, 'seed must be', id='huge seed'),
        pytest.param(('budget',), 2**63, 'budget must be', id='huge budget'),
        pytest.param(('budget',), -1, 'budget must be', id='negative budget'),
        pytest.param(('width',), 0, 'board width', id='no width'),
        pytest.param(('width',), 17, 'board width', id='huge width'),
        pytest.param(('height',), 5, '5 rows of 4 cells', id='other height'),
        pytest.param(('silhouette', 1), '####.', 'silhouette, line 2', id='ragged silhouette'),
        pytest.param(('silhouette', 1), '#?##', 'silhouette, line 2, column 2', id='odd cell'),
        pytest.param(('silhouette', 1), '#### # x', 'silhouette', id='commented silhouette'),
        pytest.param(('silhouette', 1), '', '6 rows of 4 cells', id='cut silhouette'),
        pytest.param(('silhouette', 1), 7, 'silhouette', id='number as a row'),
        pytest.param(('silhouette', 1), '####\n####', 'silhouette', id='two rows in one'),
        pytest.param(('silhouette',), [], 'silhouette', id='no silhouette'),
        pytest.param(('silhouette',), ['# '] * 10, 'silhouette', id='blank silhouette'),
        pytest.param(('library',), '1x2', 'trial_id', id='another library'),
        pytest.param(('library',), '1x2,1x2', 'listed twice', id='block twice'),
        pytest.param(('library',), '17x2', 'library', id='huge block'),
        pytest.param(('library',), '1x2, 2x1,2x2,2x4,4x2', 'library', id='library with a blank'),
        pytest.param(('strategy',), 'fast', 'strategy must be', id='unknown strategy'),
        pytest.param(('strategy',), 'none', 'no setting', id='strategy without lambda'),
        pytest.param(
            ('strategy_settings', 'lambda'), -0.1, 'lambda must be', id='negative lambda'
        ),
        pytest.param(
            ('strategy_settings', 'commit'), 'all', 'commit must be', id='unknown commit'
        ),
        pytest.param(('search',), 'dfs', 'search must be', id='unknown search'),
        pytest.param(('search',), 'exact', 'no setting', id='search without depth'),
        pytest.param(('search_settings', 'depth'), 0, 'depth must be', id='depth 0'),
        pytest.param(('search_settings', 'depth'), True, 'depth must be', id='depth as a bool'),
        pytest.param(('search_settings',), {}, 'search_settings', id='no depth'),
        pytest.param(('status',), 'done', 'status must be', id='unknown status'),
        pytest.param(('blocks',), 999, 'blocks contradicts', id='sum of blocks'),
        pytest.param(('subgoals',), 999, 'subgoals contradicts', id='sum of subgoals'),
        pytest.param(('action_planning_cost',), 9, 'action_planning_cost', id='sum of costs'),
        pytest.param(('subgoal_planning_cost',), 9, 'subgoal_planning_cost', id='sum considered'),
        pytest.param(('solution_cost',), 9, 'solution_cost', id='sum of solutions'),
        pytest.param(('observations', 1, 'landed', 0), [1, 2, 0], 'landed[0]', id='three numbers'),
        pytest.param(
            ('observations', 1, 'landed', 0), [1, 2, 0, -1], 'landed[0]', id='row below ground'
        ),
        pytest.param(
            ('observations', 1, 'landed', 0), [1, 2, 0, 17], 'landed[0]', id='row in the sky'
        ),
        pytest.param(
            ('observations', 1, 'landed', 0), [1, 2, 0, True], 'landed[0]', id='row as a bool'
        ),
        pytest.param(
            ('observations', 1, 'landed', 0), [1, 2, 0, 0.0], 'landed[0]', id='row as a float'
        ),
        pytest.param(
            ('observations', 1, 'landed', 0), '1200', 'landed[0]', id='placement as text'
        ),
        pytest.param(
            ('observations', 1, 'landed', 0), [0, 2, 0, 0], 'landed[0]', id='block without width'
        ),
        pytest.param(('decisions', 0), [], 'decisions[0]', id='decision as a list'),
        pytest.param((*DECISION, 'built'), '0x00', 'decisions[0]: built must', id='long mask'),
        pytest.param((*DECISION, 'built'), '-0x1', 'decisions[0]: built must', id='negative mask'),
        pytest.param((*DECISION, 'built'), '0xF', 'decisions[0]: built must', id='capital mask'),
        pytest.param((*DECISION, 'built'), '0x1_0', 'decisions[0]: built must', id='underscore'),
        pytest.param((*DECISION, 'built'), 'ff', 'decisions[0]: built must', id='mask without 0x'),
        pytest.param(
            (*DECISION, 'built'), hex(1 << 256), 'decisions[0]: built must', id='huge mask'
        ),
        pytest.param((*DECISION, 'built'), '0x' + 'f' * 9999, 'built must', id='endless mask'),
        pytest.param(
            (*CANDIDATE, 'status'), 'success', 'candidates[1]: status', id='status of a trial'
        ),
        pytest.param(
            (*CANDIDATE, 'regions'), [1, 17], 'regions must contain indices', id='region 17'
        ),
        pytest.param(
            (*CANDIDATE, 'regions'), [[1]], 'candidates[1]: regions must', id='nested regions'
        ),
        pytest.param((*CANDIDATE, 'cells'), -1, 'candidates[1]: cells must', id='negative cells'),
        pytest.param((*CANDIDATE, 'planning_cost'), 1 << 63, 'planning_cost must', id='huge cost'),
        pytest.param((*CANDIDATE, 'value'), 3, 'candidates[1]: value must', id='whole value'),
        pytest.param((*REGION, 'label'), {}, 'one key, the kind', id='no label'),
        pytest.param(
            (*REGION, 'label'), {'rows': [1.5]}, 'whole numbers', id='label of fractions'
        ),
        pytest.param((*REGION, 'label'), {'rows': [1] * 17}, 'at most 16', id='endless label'),
        pytest.param(
            (*SUBGOAL, 'region'), 99, 'region must contain indices', id='region that is not listed'
        ),
        pytest.param((*SUBGOAL, 'placements', 0), {}, 'placements[0]', id='plan of an object'),
    ],
)
def test_wrong_value_is_named(tmp_path: Path, path: Keys, value: object, words: str) -> None:
    assert words in refused(tmp_path, json.dumps(changed(path, value)))
