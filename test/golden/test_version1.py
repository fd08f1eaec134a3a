"""Records and bags that version 1 wrote are still read, verified and drawn.

`version1/` was made by version 0.1 of this package: a bag of four trials, one of them of a person,
and their records.
"""

from __future__ import annotations

from pathlib import Path

from bag_builders import changed_bag  # noqa: F401  finds ROS packages

from blocks_planning.ros.bagging.bags import trials_of
from blocks_planning.trials import version1
from blocks_planning.trials.reading import read_records
from blocks_planning.trials.verify import contradictions, differs_from_rerun

FOLDER = Path(__file__).parent / 'version1'


def test_records_hold() -> None:
    records = read_records(FOLDER / 'trials.jsonl')
    assert len(records) == 4
    for record in records:
        assert list(contradictions(record)) == []
        assert list(differs_from_rerun(record)) == []


def test_bag_gives_the_same_records() -> None:
    refused: list[str] = []
    found = list(trials_of(FOLDER / 'bag', refused.append))
    assert refused == []
    assert [list(one.contradictions()) for one in found] == [[]] * 4
    assert [one.record for one in found] == read_records(FOLDER / 'trials.jsonl')


def test_bag_gives_the_records_that_version_1_wrote() -> None:
    lines = (FOLDER / 'trials.jsonl').read_text(encoding='utf-8').splitlines()
    import json

    found = [version1.write(one.record) for one in trials_of(FOLDER / 'bag')]
    assert found == [json.loads(line) for line in lines]
