"""However a record is damaged, it is refused, or read and held against the rules."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import suppress
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from builders import ARCH, FRAME, NEVER_SOLVED, ODD, record_json, remade
from hypothesis import example, given, settings
from hypothesis import strategies as st
from sample_record import KEYS, LINE, OBSERVATION, SAMPLE, SUBGOAL, Keys, after_place, at, changed

from blocks_planning.errors import RecordError
from blocks_planning.trials.reading import read_records, record_from_json
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.verify import contradictions

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
@settings(max_examples=500)
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
