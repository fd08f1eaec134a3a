"""Sweeps: the tables say what the records say, wherever and however often they are begun."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from sweeps import STRATEGIES, sweep, tables_in

from blocks_planning.errors import ConfigurationError
from blocks_planning.experiments import manifest, running, sweeping, working
from blocks_planning.experiments.spec import Chunk
from blocks_planning.experiments.store import Store, read_table
from blocks_planning.experiments.sweeping import run_sweep
from blocks_planning.experiments.tables import Tables, schemas
from blocks_planning.search.many import solve_many
from blocks_planning.search.searches import BreadthFirst, Exact
from blocks_planning.trials import following
from blocks_planning.trials.flat import flat_settings
from blocks_planning.trials.local import run_trial


@pytest.fixture(scope='module')
def whole(tmp_path_factory: pytest.TempPathFactory) -> dict[str, pa.Table]:
    """The tables of the sweep, run at once in one process."""
    folder = tmp_path_factory.mktemp('whole')
    run_sweep(sweep(), folder)
    return tables_in(folder)


def test_tables_say_what_the_records_say(whole: dict[str, pa.Table]) -> None:
    specs = {s.trial_id: s for c in sweep(2).chunks() for group in c.groups() for s in group}
    trials = {row['trial_id']: row for row in whole['trials'].to_pylist()}
    assert len(trials) == whole['trials'].num_rows == 18 * 2 * 2 * len(STRATEGIES)
    settings_columns = {flat.name for flat in flat_settings()}
    decisions, placements = whole['decisions'].to_pylist(), whole['placements'].to_pylist()
    for trial_id, spec in list(specs.items())[::3]:
        record = run_trial(spec)
        row = trials[trial_id]
        assert row['experiment'] == 'small'
        assert row['error'] is None
        said = record.to_json()
        columns = row.keys() & said.keys() - settings_columns
        assert {key: row[key] for key in columns} == {key: said[key] for key in columns}
        for settings in (said['search_settings'], said['strategy_settings']):
            assert {key: row[key] for key in settings} == settings
        mine = [r for r in decisions if r['trial_id'] == trial_id]
        assert [r['built'] for r in mine] == [d['built'] for d in said['decisions']]
        assert [r['subgoal_planning_cost'] for r in mine] == [
            d['subgoal_planning_cost'] for d in said['decisions']
        ]
        assert [r['considered'] for r in mine] == [
            sum(c['planning_cost'] for c in d['candidates']) for d in said['decisions']
        ]
        blocks = [r for r in placements if r['trial_id'] == trial_id]
        assert [r['placement'] for r in blocks] == list(range(record.blocks))
        assert [[r['width'], r['height'], r['column'], r['row']] for r in blocks] == said[
            'placements'
        ]


def test_schemas(whole: dict[str, pa.Table]) -> None:
    for name, schema in schemas()._asdict().items():
        assert whole[name].schema.equals(schema)


def test_two_processes_give_identical_tables(tmp_path: Path, whole: dict[str, pa.Table]) -> None:
    run_sweep(sweep(), tmp_path, workers=2)
    assert tables_in(tmp_path) == whole


@pytest.mark.parametrize('workers', [1, 2])
def test_interrupted_sweep_goes_on(
    tmp_path: Path, whole: dict[str, pa.Table], workers: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(done: int, total: int) -> None:
        assert total == 360
        if done >= 90:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_sweep(sweep(), tmp_path, workers, report=interrupt)
    there = {part.name for part in (tmp_path / 'parts').iterdir()}
    assert 1 <= len(there) < len(sweep().chunks())
    left = next(c for c in sweep().chunks() if c.chunk_id not in there)
    (tmp_path / 'parts' / f'{left.chunk_id}.half').mkdir()  # killed while it was written
    for table in (tmp_path / 'parts' / min(there)).iterdir():  # as an earlier version left it
        pq.write_table(pa.ipc.open_file(table).read_all(), table.with_suffix('.parquet'))
        table.unlink()
    ran: list[str] = []

    def run(chunk: Chunk) -> Tables:
        ran.append(chunk.chunk_id)
        return working.run_chunk(chunk)

    monkeypatch.setattr(running, 'run_chunk', run)
    reported: list[tuple[int, int]] = []
    run_sweep(sweep(), tmp_path, report=lambda *counts: reported.append(counts))
    done = sum(chunk.trials for chunk in sweep().chunks() if chunk.chunk_id in there)
    assert (reported[0], reported[-1]) == ((done, 360), (360, 360))
    assert set(ran) == {chunk.chunk_id for chunk in sweep().chunks()} - there
    assert tables_in(tmp_path) == whole
    assert not (tmp_path / 'parts').exists()


def test_finished_sweep_is_not_run_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = run_sweep(sweep(1), tmp_path)
    monkeypatch.setattr(sweeping, 'run_here', lambda *_: pytest.fail('ran again'))
    assert run_sweep(sweep(1), tmp_path) == first


def test_each_solve_is_done_once(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []

    def counted(problems: Any, *trial: Any, **options: Any) -> Any:
        asked.extend((one.task, one.built, one.region, *trial) for one in problems)
        return solve_many(problems, *trial, **options)

    monkeypatch.setattr(following, 'solve_many', counted)
    for chunk in sweep(2).chunks():
        working.run_chunk(chunk)
    assert len(asked) == len(set(asked)) > 0


def test_failed_trial_is_a_row_that_says_why(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def break_down(*_: Any) -> None:
        raise RuntimeError('the yardstick broke')

    monkeypatch.setattr(Exact, 'run', break_down)
    summary = run_sweep(sweep(1, (Exact(), BreadthFirst(1))), tmp_path)
    assert summary.failed == 2 * len(STRATEGIES)
    assert summary.trials == 2 * summary.failed
    [(error, count)] = summary.failures.items()
    assert error == 'RuntimeError: the yardstick broke'
    assert count == summary.failed
    rows = read_table(tmp_path, 'trials').to_pylist()
    failed = [row for row in rows if row['status'] == 'failed']
    assert {row['search'] for row in failed} == {'exact'}
    assert {row['blocks'] for row in failed} == {None}
    others = {row['trial_id'] for row in failed} & {
        row['trial_id'] for row in read_table(tmp_path, 'placements').to_pylist()
    }
    assert others == set()


def test_trial_that_ends_at_a_limit_of_memory_has_failed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from blocks_planning.search import exact

    monkeypatch.setattr(exact, 'MAX_STATES', 3)
    summary = run_sweep(sweep(1, (Exact(), BreadthFirst(1))), tmp_path)
    assert 0 < summary.failed < summary.trials
    assert list(summary.failures) == ['exact: the search would have exceeded its memory']


def test_folder_of_another_sweep_is_refused(tmp_path: Path) -> None:
    run_sweep(sweep(1), tmp_path)
    with pytest.raises(ConfigurationError, match='contains another sweep'):
        run_sweep(sweep(2), tmp_path)


def test_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / 'file').write_text('')
    with pytest.raises(ConfigurationError, match=f'--out {tmp_path}/file/x: Not a directory'):
        Store(tmp_path / 'file' / 'x', sweep(1))


def test_manifest_says_what_ran(tmp_path: Path) -> None:
    run_sweep(sweep(1), tmp_path)
    said = json.loads((tmp_path / 'manifest.json').read_text())
    assert said['sweep_id'] == sweep(1).sweep_id
    assert said['sweep']['seeds'] == [0]
    assert said['sweep']['experiments'][0]['searches'][0] == {
        'name': 'bfs', 'depth': 2, 'dead_ends': 'worst',
    }  # fmt: skip
    assert said['provenance']['libraries']['numpy']
    assert said['provenance']['machine']['processors'] >= 1


def test_manifest_marks_a_revision_with_changes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / 'package' / 'folder' / 'manifest.py'
    monkeypatch.setattr(manifest, '__file__', str(path))
    assert manifest.provenance()['git_revision'] is None
    for words in (
        ('init', '--quiet'),
        ('-c', 'user.name=a', '-c', 'user.email=a@b', 'commit', '-qm', 'a', '--allow-empty'),
    ):
        subprocess.run(['git', *words], cwd=tmp_path, check=True)
    clean = manifest.provenance()['git_revision']
    assert re.fullmatch('[0-9a-f]{40}', clean)
    path.parent.mkdir(parents=True)
    path.write_text('')
    assert manifest.provenance()['git_revision'] == f'{clean}+'


def test_missing_table_is_named(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=r'trials.parquet: does not exist'):
        read_table(tmp_path, 'trials')
