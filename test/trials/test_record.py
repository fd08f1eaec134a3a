"""Records of trials: written, and read back."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from builders import (
    ARCH,
    CHAIR,
    PLANNERS,
    SQUARE,
    TOWERS,
    cancelled_record,
    planner_id,
    record,
    spec,
)
from sample_record import DECISION, KEYS, LINE, SAMPLE, at

from blocks_planning.trials.reading import read_records, record_from_json
from blocks_planning.trials.status import TrialStatus


def test_the_sample_has_something_of_everything() -> None:
    record_from_json(SAMPLE, 'sample')
    assert list(SAMPLE) == KEYS
    assert len(SAMPLE['decisions']) > 1
    assert all(at(SAMPLE, (*DECISION, key)) for key in ('candidates', 'subgoals'))


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
