"""Running chunks: in this process, in several of this machine, or on the workers of Dask.

Results arrive in any order and do not depend on where they were computed.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Generator, Sequence

from blocks_planning.errors import ConfigurationError
from blocks_planning.experiments.spec import Chunk
from blocks_planning.experiments.tables import Tables
from blocks_planning.experiments.working import run_chunk
from blocks_planning.extras import extra

Results = Generator[tuple[Chunk, Tables], None, None]

CONNECT_TIMEOUT_S = 10
IN_FLIGHT_PER_THREAD = 4
"""Number of waiting chunks per thread of a Dask worker, so that it always has work."""


def default_workers() -> int:
    """Number of processors that this process may use."""
    if hasattr(os, 'sched_getaffinity'):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1  # macOS and Windows have no processor affinity here


def run_here(chunks: Sequence[Chunk], workers: int) -> Results:
    """Run chunks in several processes of this machine; with one worker, in this process."""
    with extra('experiments'):
        from joblib import Parallel, delayed

    if workers == 1 or len(chunks) < 2:
        for chunk in chunks:
            yield chunk, run_chunk(chunk)
        return
    # Ordered, because older releases of joblib have no other mode; chunks are small.
    parallel = Parallel(n_jobs=workers, return_as='generator')
    results = parallel(delayed(run_chunk)(chunk) for chunk in chunks)
    try:
        yield from zip(chunks, results, strict=True)
    finally:
        with warnings.catch_warnings():
            warnings.simplefilter('ignore', UserWarning)  # warnings about cancelled chunks
            results.close()


def run_on_dask(chunks: Sequence[Chunk], address: str) -> Results:
    """Run chunks on a Dask cluster. If a worker dies, another one repeats its chunks.

    Raises:
        ConfigurationError: if the scheduler cannot be reached.
    """
    with extra('experiments'):
        from dask.distributed import Client, as_completed

    try:
        client = Client(address, timeout=CONNECT_TIMEOUT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        reason = str(error).splitlines()[0] if str(error) else 'no answer'
        raise ConfigurationError(f'--dask {address}: cannot be reached: {reason}') from None
    with client:
        threads = sum(client.nthreads().values())
        waiting = iter(chunks)
        running = as_completed(loop=client.loop, with_results=True)
        by_key: dict[str, Chunk] = {}

        def submit() -> None:
            for chunk in waiting:
                future = client.submit(run_chunk, chunk, key=f'chunk-{chunk.chunk_id}')
                by_key[future.key] = chunk
                running.add(future)
                return

        for _ in range(max(1, IN_FLIGHT_PER_THREAD * threads)):
            submit()
        for future, tables in running:
            submit()
            yield by_key.pop(future.key), tables
