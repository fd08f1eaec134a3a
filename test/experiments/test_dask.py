"""Sweeps on a real Dask cluster of separate processes, one of which is killed on the way."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from sweeps import sweep, tables_in

from blocks_planning.errors import ConfigurationError
from blocks_planning.experiments.running import run_on_dask
from blocks_planning.experiments.sweeping import run_sweep

pytestmark = pytest.mark.filterwarnings('default')  # of its networking


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Any]:
    distributed: Any = pytest.importorskip('dask.distributed')
    with distributed.LocalCluster(
        n_workers=2,
        threads_per_worker=1,
        processes=True,
        dashboard_address=None,
        host='127.0.0.1',
        local_directory=str(tmp_path / 'dask'),
    ) as cluster:
        yield cluster


@pytest.mark.long
def test_same_tables_though_a_worker_is_killed(tmp_path: Path, cluster: Any) -> None:
    pids = [worker.pid for worker in cluster.workers.values()]
    assert len(set(pids)) == 2
    assert os.getpid() not in pids
    killed: list[int] = []

    def kill_one(done: int, total: int) -> None:
        if done and not killed:
            os.kill(pids[0], signal.SIGKILL)
            killed.append(pids[0])

    summary = run_sweep(
        sweep(), tmp_path / 'dask', dask=cluster.scheduler_address, report=kill_one
    )
    assert killed
    assert summary.failed == 0
    run_sweep(sweep(), tmp_path / 'here')
    assert tables_in(tmp_path / 'dask') == tables_in(tmp_path / 'here')


def test_address_where_nobody_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    from blocks_planning.experiments import running

    monkeypatch.setattr(running, 'CONNECT_TIMEOUT_S', 0.5)
    with pytest.raises(ConfigurationError, match=r'--dask tcp://127.0.0.1:1: cannot be reached'):
        list(run_on_dask(sweep().chunks(), 'tcp://127.0.0.1:1'))
