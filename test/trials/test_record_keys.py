"""Keys that are missing, unknown or doubled, and values of another type are refused."""

from __future__ import annotations

import json
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from builders import SQUARE, record_json
from sample_record import COUNTS, OBJECTS, PARTS, SAMPLE, Keys, at, changed, name_of, refused


@pytest.mark.parametrize(('path', 'key'), OBJECTS, ids=name_of)
def test_missing_key_is_named(tmp_path: Path, path: Keys, key: str) -> None:
    data = deepcopy(SAMPLE)
    del at(data, path)[key]
    assert f"missing key '{key}'" in refused(tmp_path, json.dumps(data))


@pytest.mark.parametrize(
    'path', [*PARTS, ('search_settings',), ('strategy_settings',)], ids=name_of
)
def test_unknown_key_is_refused(tmp_path: Path, path: Keys) -> None:
    message = refused(tmp_path, json.dumps(changed((*path, 'extra'), 1)))
    assert any(word in message for word in ('extra', 'decisions', 'observations'))


@pytest.mark.parametrize('path', PARTS, ids=name_of)
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


@pytest.mark.parametrize(('path', 'key'), OBJECTS, ids=name_of)
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


@pytest.mark.parametrize(('path', 'key'), COUNTS, ids=name_of)
def test_equal_number_of_another_type_is_refused(tmp_path: Path, path: Keys, key: str) -> None:
    number = at(SAMPLE, (*path, key))
    assert key in refused(tmp_path, json.dumps(changed((*path, key), float(number))))


def test_true_is_not_one(tmp_path: Path) -> None:
    data = record_json(SQUARE, strategy='none')
    assert data['subgoals'] == 1
    data['subgoals'] = True
    assert 'subgoals' in refused(tmp_path, json.dumps(data))
