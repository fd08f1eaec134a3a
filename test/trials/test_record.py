"""Records are read back as they were written; anything else is refused, with its place."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import suppress
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from builders import (
    ARCH,
    CHAIR,
    FRAME,
    NEVER_SOLVED,
    ODD,
    PLANNERS,
    SQUARE,
    TOWERS,
    cancelled_record,
    planner_id,
    record,
    record_json,
    remade,
    spec,
)
from hypothesis import example, given, settings
from hypothesis import strategies as st

from blocks_planning.errors import RecordError
from blocks_planning.trials.reading import read_records, record_from_json
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions

KEYS = [
    *('format', 'version', 'trial_id', 'stimulus', 'width', 'height', 'silhouette', 'library'),
    *('built', 'strategy', 'strategy_settings', 'search', 'search_settings'),
    *('world', 'world_settings', 'seed', 'budget', 'status', 'reason'),
    *('blocks', 'orders', 'surprises', 'subgoals'),
    *('action_planning_cost', 'subgoal_planning_cost', 'solution_cost'),
    *('recall', 'precision', 'f1', 'iou'),
    *('placements', 'observations', 'decisions', 'proposals'),
]
# Three decisions, in the first several candidates, the first of them unsolved.
SAMPLE = record_json(CHAIR, lam=0.2, depth=2)
OBSERVATION, DECISION, REGION, CANDIDATE, SUBGOAL = (
    ('observations', 1),
    ('decisions', 0),
    ('decisions', 0, 'regions', 1),
    ('decisions', 0, 'candidates', 1),
    ('decisions', 0, 'subgoals', 0),
)
Keys = tuple[str | int, ...]


def at(data: Any, path: Keys) -> Any:
    """A part of some JSON."""
    for key in path:
        data = data[key]
    return data


def changed(path: Keys, value: object) -> dict[str, Any]:
    """The sample with one value changed."""
    data = deepcopy(SAMPLE)
    at(data, path[:-1])[path[-1]] = value
    return data


def refused(tmp_path: Path, text: str) -> str:
    """The message, after the place, with which line 2 of a file is refused."""
    path = tmp_path / 'records.jsonl'
    path.write_text(f'{json.dumps(SAMPLE)}\n{text}\n')
    with pytest.raises(RecordError) as caught:
        read_records(path)
    return after_place(caught.value, f'{path}, line 2')


def after_place(error: RecordError, place: str) -> str:
    """The message of an error, which begins with its place and has one line."""
    message = str(error)
    assert len(message.splitlines()) == 1
    assert message.startswith(place)
    return message.removeprefix(place)


def test_the_sample_has_something_of_everything() -> None:
    record_from_json(SAMPLE, 'sample')
    assert list(SAMPLE) == KEYS
    assert len(SAMPLE['decisions']) > 1
    assert all(at(SAMPLE, (*DECISION, key)) for key in ('candidates', 'subgoals'))


def test_place_is_named_once(tmp_path: Path) -> None:
    for path in (('silhouette', 1), ('library',), ('width',)):
        message = refused(tmp_path, json.dumps(changed(path, '?')))
        assert str(tmp_path) not in message


# Written and read back.


@pytest.mark.parametrize('planner', PLANNERS, ids=planner_id)
def test_record_is_read_back_equal(planner: dict[str, Any]) -> None:
    for rows in TOWERS:
        written = record(rows, budget=300, seed=2**64 - 1, **planner)
        line = written.to_line()
        assert '\n' not in line
        read = record_from_json(json.loads(line), 'x')
        assert read == written
        assert read.to_line() == line
        assert list(json.loads(line)) == KEYS


@pytest.mark.parametrize(
    'stimulus',
    ['', 'a b', 'tower "9"', 'a\\b\n', '\u2028', 'T\u00fcrme', '\0', '\udcff', '[red]x[/]'],
)
def test_any_name_is_read_back_from_a_file(tmp_path: Path, stimulus: str) -> None:
    path = tmp_path / 'record.json'
    written = record(ARCH, stimulus=stimulus)
    path.write_text(written.to_line())
    assert read_records(path) == [written]


@pytest.mark.parametrize('lam', [0.0, -0.0, 1, 1e-300, 0.1 + 0.2, 1e300])
def test_any_lambda_is_read_back(lam: float) -> None:
    written = record(ARCH, lam=lam)
    assert record_from_json(json.loads(written.to_line()), 'x') == written


def test_largest_lambda_gives_a_record_that_can_be_written() -> None:
    written = record(SQUARE, lam=1.7976931348623157e308)
    assert record_from_json(json.loads(written.to_line()), 'x') == written


def test_largest_budget_and_seed_are_read_back() -> None:
    written = record(ARCH, budget=2**63 - 1, seed=2**64 - 1)
    assert record_from_json(json.loads(written.to_line()), 'x') == written


def test_cancelled_record_is_read_back() -> None:
    written = cancelled_record(spec(CHAIR, lam=0.2, depth=2), 12)
    assert written.status is TrialStatus.CANCELLED
    assert record_from_json(json.loads(written.to_line()), 'x') == written


LINE = record().to_line()
OTHER = record(CHAIR).to_line()


@pytest.mark.parametrize(
    ('text', 'lines'),
    [
        pytest.param(f'{LINE}\n', [LINE], id='one line'),
        pytest.param(LINE, [LINE], id='no final newline'),
        pytest.param(f'{LINE}\n{OTHER}\n', [LINE, OTHER], id='two lines'),
        pytest.param(f'{LINE}\n{LINE}\n', [LINE, LINE], id='the same twice'),
        pytest.param(f'\n\n{LINE}\n \t\n{OTHER}\n\n', [LINE, OTHER], id='blank lines'),
        pytest.param(f'{LINE}\r\n{OTHER}\r\n', [LINE, OTHER], id='CRLF'),
        pytest.param(f'  {LINE}  \n', [LINE], id='blanks around'),
        pytest.param(json.dumps(json.loads(LINE), indent=1), [LINE], id='laid out'),
        pytest.param(
            json.dumps(json.loads(LINE), indent='\t').replace('\n', '\r\n'),
            [LINE],
            id='laid out, CRLF',
        ),
        pytest.param(
            json.dumps(dict(reversed(json.loads(LINE).items()))), [LINE], id='other order'
        ),
    ],
)
def test_file_of_records(tmp_path: Path, text: str, lines: list[str]) -> None:
    path = tmp_path / 'records.jsonl'
    path.write_bytes(text.encode())
    assert [found.to_line() for found in read_records(path)] == lines


# Damage.


PARTS: list[Keys] = [(), OBSERVATION, DECISION, REGION, CANDIDATE, SUBGOAL]
OBJECTS = [(path, key) for path in PARTS for key in at(SAMPLE, path)]


def _name(path: object) -> str:
    return '.'.join(map(str, path)) or 'record' if isinstance(path, tuple) else str(path)


@pytest.mark.parametrize(('path', 'key'), OBJECTS, ids=_name)
def test_missing_key_is_named(tmp_path: Path, path: Keys, key: str) -> None:
    data = deepcopy(SAMPLE)
    del at(data, path)[key]
    assert f"missing key '{key}'" in refused(tmp_path, json.dumps(data))


@pytest.mark.parametrize('path', [*PARTS, ('search_settings',), ('strategy_settings',)], ids=_name)
def test_unknown_key_is_refused(tmp_path: Path, path: Keys) -> None:
    message = refused(tmp_path, json.dumps(changed((*path, 'extra'), 1)))
    assert any(word in message for word in ('extra', 'decisions', 'observations'))


@pytest.mark.parametrize('path', PARTS, ids=_name)
def test_doubled_key_is_refused(tmp_path: Path, path: Keys) -> None:
    for key, value in at(SAMPLE, path).items():
        text = json.dumps(changed((*path, 'doubled'), value)).replace('"doubled"', f'"{key}"')
        assert key in refused(tmp_path, text)


WRONG: list[Any] = [
    None,
    True,
    False,
    -1,
    1.5,
    'x',
    [],
    {},
    [None],
    10**30,
    'NaN',
    '0x',
    ['x'],
    [[1, 2, 0]],
]
# Of these a record may have others than those it has: the reader can't know.
FREE: dict[str, tuple[Any, ...]] = {
    'value': (None, 1.5),
    'probability': (None, 1.5),
    'chosen': (None,),
    'regions': ([],),
}


# The rules, not the reader, know that these must not be empty or absent.
MAY_BE_EMPTY = {'proposals', 'candidates', 'placements', 'built', 'landed', 'gone', 'observations'}
ALSO: dict[str, tuple[Any, ...]] = {
    'ordered': (None,),
    'world_settings': ({},),
    'reason': ('x', 'NaN', '0x'),
}


@pytest.mark.parametrize(('path', 'key'), OBJECTS, ids=_name)
def test_wrong_type_is_refused(tmp_path: Path, path: Keys, key: str) -> None:
    for wrong in WRONG:
        if path and any(wrong is free or wrong == free for free in FREE.get(key, ())):
            continue
        if wrong == [] and key in MAY_BE_EMPTY:
            continue
        if any(type(wrong) is type(free) and wrong == free for free in ALSO.get(key, ())):
            continue
        message = refused(tmp_path, json.dumps(changed((*path, key), wrong)))
        names = (key, 'trial_id', 'blocks', 'subgoals', 'cost', 'expected format', 'setting')
        assert any(name in message for name in names)


COUNTS = [(path, key) for path, key in OBJECTS if type(at(SAMPLE, (*path, key))) is int]


@pytest.mark.parametrize(('path', 'key'), COUNTS, ids=_name)
def test_equal_number_of_another_type_is_refused(tmp_path: Path, path: Keys, key: str) -> None:
    number = at(SAMPLE, (*path, key))
    assert key in refused(tmp_path, json.dumps(changed((*path, key), float(number))))


def test_true_is_not_one(tmp_path: Path) -> None:
    data = record_json(SQUARE, strategy='none')
    assert data['subgoals'] == 1
    data['subgoals'] = True
    assert 'subgoals' in refused(tmp_path, json.dumps(data))


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
    ids=_name,
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


@pytest.mark.parametrize('end', [1, 2, 100, len(LINE) // 2, len(LINE) - 1])
def test_cut_line_is_refused(tmp_path: Path, end: int) -> None:
    assert refused(tmp_path, LINE[:end]).startswith(': is not JSON: ')


@pytest.mark.parametrize(
    'text', ['words', '{,}', "{'a': 1}", '{} {}', 'nul', '"', '\\', '\x00', '\ufeff{}']
)
def test_what_is_no_json_is_refused(tmp_path: Path, text: str) -> None:
    assert refused(tmp_path, text).startswith(': is not JSON: ')


@pytest.mark.parametrize('text', ['null', '1', '"x"', '[]', 'true', '[{}]'])
def test_what_is_no_object_is_refused(tmp_path: Path, text: str) -> None:
    assert refused(tmp_path, text) == f': expected an object, got {text}'


def test_deep_nesting_is_refused(tmp_path: Path) -> None:
    for depth in (2, 10, *range(800, 1010, 3), 5000, 100_000):
        nested = '[' * depth + ']' * depth
        refused(tmp_path, nested)
        for path in (
            ('stimulus',),
            ('silhouette',),
            ('strategy_settings', 'lambda'),
            ('search_settings', 'depth'),
            ('decisions',),
            (*CANDIDATE, 'regions'),
            ('extra',),
        ):
            refused(tmp_path, json.dumps(changed(path, 'HERE')).replace('"HERE"', nested))


def test_record_that_is_laid_out_is_refused_by_file_and_key(tmp_path: Path) -> None:
    path = tmp_path / 'record.json'
    for data, words in (
        (changed((*CANDIDATE, 'cells'), -1), 'decisions[0], candidates[1]: cells must'),
        (changed(('blocks',), 7000), 'blocks contradicts'),
    ):
        path.write_text(json.dumps(data, indent=2))
        with pytest.raises(RecordError) as caught:
            read_records(path)
        assert words in after_place(caught.value, str(path))
    path.write_text(json.dumps(SAMPLE, indent=2)[:200])
    with pytest.raises(RecordError, match='is not JSON'):
        read_records(path)


@pytest.mark.parametrize('data', [b'', b'\n', b' \r\n\t\n'])
def test_file_without_records_is_refused(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / 'empty.json'
    path.write_bytes(data)
    with pytest.raises(RecordError) as caught:
        read_records(path)
    assert after_place(caught.value, str(path)) == ': is empty, expected trial records'


def test_file_that_cannot_be_read_is_refused(tmp_path: Path) -> None:
    loop, binary = tmp_path / 'loop', tmp_path / 'binary'
    loop.symlink_to(loop)
    binary.write_bytes(b'{}\n\x80\x81')
    for path, words in (
        (tmp_path, 'cannot be read: Is a directory'),
        (tmp_path / 'missing.json', 'cannot be read: No such file or directory'),
        (loop, 'cannot be read: Too many levels of symbolic links'),
        (tmp_path / ('x' * 300), 'cannot be read: File name too long'),
        (binary, 'is not a text file (byte 3)'),
    ):
        with pytest.raises(RecordError) as caught:
            read_records(path)
        assert after_place(caught.value, str(path)) == f': {words}'


def test_path_with_a_nul_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RecordError):
        read_records(tmp_path / 'a\0b')


# Any damage.


SAMPLES = [
    SAMPLE,
    record_json(ARCH, strategy='none', search='astar', iterations=9),
    record_json(FRAME, strategy='full', search='random'),
    record_json(ODD, commit='action', search='best_first', iterations=9),
    record_json(NEVER_SOLVED, search='exact'),
]
_LEAVES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.sampled_from(
        [0, 1, 2, 3, 4, 16, 17, 2**63, 2**64, 10**400, 1e308, float('inf'), float('nan'), 0.0]
    ),
    st.floats(),
    st.sampled_from(
        [
            '',
            '####',
            '.',
            '0x0',
            '0xffff',
            '1x2',
            'solved',
            'success',
            'cancelled',
            'none',
            'full',
            '\ud800',
        ]
    ),
    st.text(max_size=4),
)
_VALUES = st.recursive(
    _LEAVES,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4), st.dictionaries(st.sampled_from(KEYS), inner, max_size=3)
    ),
    max_leaves=6,
)


def _nodes(data: Any, path: Keys = ()) -> list[Keys]:
    """The paths of all parts of some JSON but the whole."""
    keys = data if isinstance(data, dict) else range(len(data)) if isinstance(data, list) else ()
    return [p for key in keys for p in ((*path, key), *_nodes(data[key], (*path, key)))]


def _damage(draw: Callable[..., Any], data: Any) -> None:
    *above, key = draw(st.sampled_from(_nodes(data)))
    holder = at(data, tuple(above))
    match draw(st.sampled_from(['delete', 'replace', 'nudge', 'double', 'exchange'])):
        case 'delete':
            del holder[key]
        case 'replace':
            holder[key] = draw(_VALUES)
        case 'nudge' if type(holder[key]) is int:
            holder[key] = draw(st.sampled_from([holder[key] - 1, holder[key] + 1, 0, 16]))
        case 'exchange':
            holder[key] = deepcopy(at(data, draw(st.sampled_from(_nodes(data)))))
        case 'double' if isinstance(holder, list):
            holder.insert(key, deepcopy(holder[key]))
        case 'double':
            holder[f'{key}_'] = deepcopy(holder[key])


@st.composite
def _damaged(draw: st.DrawFn) -> dict[str, Any]:
    data: dict[str, Any] = deepcopy(draw(st.sampled_from(SAMPLES)))
    for _ in range(draw(st.integers(1, 3))):
        if _nodes(data):
            _damage(draw, data)
    if draw(st.booleans()):  # so that more of it is read
        with suppress(KeyError, TypeError, AttributeError, ValueError):
            remade(data)
    return data


def read_or_refused(path: Path) -> list[TrialRecord]:
    """The records of a file; none if it is refused as it should be."""
    try:
        return read_records(path)
    except RecordError as error:
        after_place(error, str(path))
        return []


@given(_damaged())
@example(remade(changed((*OBSERVATION, 'landed', 0, 0), 0)))
@example(remade(changed((*SUBGOAL, 'placements', 0, 0), 0)))
@settings(max_examples=1000)
def test_any_damage_is_refused_or_held_against_the_rules(
    tmp_path_factory: pytest.TempPathFactory, data: dict[str, Any]
) -> None:
    path = tmp_path_factory.getbasetemp() / 'damaged.json'
    path.write_text(json.dumps(data))
    read = read_or_refused(path)
    for found in read:
        assert all(isinstance(sentence, str) for sentence in contradictions(found))
        assert record_from_json(json.loads(found.to_line()), 'x') == found


@given(st.integers(0, len(LINE)), st.text(max_size=3), st.integers(0, 5))
def test_any_damaged_text_is_refused_or_read(
    tmp_path_factory: pytest.TempPathFactory, start: int, new: str, length: int
) -> None:
    path = tmp_path_factory.getbasetemp() / 'damaged.jsonl'
    text = LINE[:start] + new + LINE[start + length :]
    path.write_bytes(text.encode('utf-8', 'surrogatepass'))
    for found in read_or_refused(path):
        list(contradictions(found))
