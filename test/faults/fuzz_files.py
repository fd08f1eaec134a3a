"""Spoilt files, given to everything that reads files.

``python -m faults.fuzz_files COUNT SEED`` (in ``test/``) spoils COUNT files of eight kinds. Each is
read, or refused with one error of ours on one line; some go through the command, which must end
with exit code 0, 1 or 2 and never with a traceback.
"""

from __future__ import annotations

import io
import json
import os
import random
import shutil
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from unittest.mock import patch

os.environ.setdefault('AMENT_PREFIX_PATH', sys.prefix)

import rclpy
from bag_builders import trial_said, write_bag
from builders import CHAIR, SQUARE, record, spec
from rclpy.context import Context
from rclpy.signals import SignalHandlerOptions
from source_imports import ROOT

from blocks_planning.board.pictures import read_file
from blocks_planning.cli import main as command
from blocks_planning.errors import BlocksPlanningError
from blocks_planning.experiments.reading import read_sweep
from blocks_planning.ros.bagging.bags import repair, trials_of
from blocks_planning.ros.runtime.journal import Journal
from blocks_planning.ros.runtime.process import initialise
from blocks_planning.trials import script
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.reading import read_records
from blocks_planning.trials.recordfile import RecordFile
from blocks_planning.trials.verify import contradictions
from blocks_planning.worlds.world import make_world
from faults.mutations import spoilt

MOST_TRIALS = 20_000
"""A spoilt script may still be a good one, of more trials than there is time for."""
UNCERTAIN = make_world('simulated', {'slip': 0.4, 'loss': 0.4, 'blocks': 'loose'})
LONGEST_S = 20.0
MOST_LETTERS = 1500
ONE_IN = 25
"""One file in so many goes through the command too."""

Read = Callable[[Path], object]
Way = tuple[str, ...]


@dataclass(frozen=True)
class Kind:
    """A kind of file: good ones, who reads it, and the command that takes it."""

    name: str
    good: tuple[bytes, ...]
    read: Read
    command: Way = ()
    weight: int = 12


def _records(path: Path) -> object:
    return [list(contradictions(found)) for found in read_records(path)]


def _finished(path: Path) -> object:
    RecordFile(path).close()
    return None


def _journal(path: Path) -> object:
    placements, warning = Journal(path.parent).begin(path.stem)
    return [placements, _checked(warning)]


def _bag(path: Path) -> object:
    repair(path.parent)
    return [_checked(said) for trial in trials_of(path.parent) for said in trial.contradictions()]


def _parameters(path: Path) -> object:
    context = Context()
    try:
        initialise(['--ros-args', '--params-file', str(path)], context)
    finally:
        with suppress(RuntimeError):
            rclpy.shutdown(context=context)
    return SignalHandlerOptions.NO


def kinds(folder: Path) -> list[Kind]:
    """Every kind of file."""
    config = ROOT / 'config'
    uncertain = [replace(spec(tower), world=UNCERTAIN) for tower in (SQUARE, CHAIR)]
    bag = write_bag(
        folder / 'bag', [one for said in (spec(CHAIR), *uncertain) for one in trial_said(said)[1]]
    )
    journal = (
        b'blocks_planning/journal 2\n2 1 0;2 1 0 0;\n1 2 3;;\n2 2 1;2 2 0 1;2 1 0 0,1 1 1 0\n'
    )
    lines = [
        record(tower, strategy=name).to_line()
        for tower in (SQUARE, CHAIR)
        for name in ('none', 'full')
    ]
    lines += [run_trial(said).to_line() for said in uncertain]
    good_records = (
        '\n'.join([*lines, '']).encode(),
        lines[-1].encode(),
        json.dumps(json.loads(lines[0]), indent=1).encode(),
    )
    scripts = tuple(path.read_bytes() for path in sorted((config / 'trials').glob('*.yaml')))
    sweeps = tuple(path.read_bytes() for path in sorted((config / 'sweeps').glob('*.yaml')))
    towers = tuple(path.read_bytes() for path in sorted((ROOT / 'stimuli').glob('*.txt')))
    return [
        Kind('towers.txt', towers, read_file, ('stimuli', 'show', '{}')),
        Kind('script.yaml', scripts, script.read_script),
        Kind('sweep.yaml', sweeps, read_sweep),
        Kind('records.jsonl', good_records, _records, ('verify', '{}')),
        Kind('trials.jsonl', good_records[:1], _finished),
        Kind('nodes.yaml', ((config / 'nodes.yaml').read_bytes(),), _parameters),
        Kind('a.journal', (journal,), _journal),
        Kind('bag_0.mcap', ((bag / 'bag_0.mcap').read_bytes(),), _bag, ('verify', '{}'), 1),
        Kind(
            'metadata.yaml', ((bag / 'metadata.yaml').read_bytes(),), _bag, ('verify', '{bag}'), 1
        ),
    ]


def fuzz(folder: Path, count: int, seed: int) -> tuple[Counter[str], list[str]]:
    """Spoil and read so many files; return what came of them, and what must not be."""
    chance = random.Random(seed)
    came: Counter[str] = Counter()
    failures: list[str] = []
    every = kinds(folder / 'good')
    weights = [kind.weight for kind in every]
    with patch.object(script, 'MAX_TRIALS', MOST_TRIALS), _quiet():
        for number in range(count):
            (kind,) = chance.choices(every, weights)
            data = spoilt(chance, chance.choice(kind.good))
            path = _put(folder, kind, data)
            began = time.monotonic()
            try:
                came[f'{kind.name}: {_outcome(kind, path)}'] += 1
                if kind.command and number % ONE_IN == 0:
                    came[f'{kind.name}: command'] += 1
                    _command(kind, path)
            except BaseException as error:  # noqa: BLE001  that is what is looked for
                kept = folder / f'failed_{number}_{kind.name}'
                kept.write_bytes(data)
                failures.append(
                    f'{kind.name}, file {number}: {type(error).__name__}: {error}'[:400]
                )
            if time.monotonic() - began > LONGEST_S:
                failures.append(f'{kind.name}, file {number}: {time.monotonic() - began:.0f} s')
    return came, failures


def _put(folder: Path, kind: Kind, data: bytes) -> Path:
    """A spoilt file, beside good ones if it is of a bag."""
    place = folder / 'spoilt'
    shutil.rmtree(place, ignore_errors=True)
    if kind.read is _bag:
        shutil.copytree(folder / 'good' / 'bag', place)
    else:
        place.mkdir()
    path = place / kind.name
    path.write_bytes(data)
    return path


def _outcome(kind: Kind, path: Path) -> str:
    try:
        kind.read(path)
    except BlocksPlanningError as error:
        _checked(str(error))
        return 'refused'
    return 'read'


def _checked(message: str) -> str:
    """An error message, which must be one line that can be read."""
    if '\n' in message or len(message) > MOST_LETTERS:
        raise AssertionError(f'not one clear line: {message[:300]!r}')
    return message


def _command(kind: Kind, path: Path) -> None:
    """What the command does with it."""
    words = [word.format(path, bag=path.parent) for word in kind.command]
    out, err = io.TextIOWrapper(io.BytesIO(), 'utf-8'), io.TextIOWrapper(io.BytesIO(), 'utf-8')
    with (
        patch.object(sys, 'argv', ['blocks-planning', *words]),
        redirect_stdout(out),
        redirect_stderr(err),
    ):
        try:
            command()
        except SystemExit as end:
            code = end.code or 0
    err.seek(0)
    said = err.read()
    if code not in (0, 1, 2) or (code == 2 and len(said.splitlines()) != 1):
        raise AssertionError(f'{words}: exit code {code}, said {said[:300]!r}')


@contextmanager
def _quiet() -> Iterator[None]:
    """Without what the middleware prints by itself."""
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)


def main() -> int:
    """Print what came of it; return 1 if something must not be."""
    count, seed = (*map(int, sys.argv[1:]), *(20_000, 0)[len(sys.argv) - 1 :])[:2]
    began = time.monotonic()
    folder = Path(tempfile.mkdtemp(prefix='fuzz_files_'))
    came, failures = fuzz(folder, count, seed)
    lines = [f'files: {count} in {time.monotonic() - began:.0f} s (seed {seed})']
    lines += [f'  {name}: {number}' for name, number in sorted(came.items())]
    lines += [f'FAILED: {failure}' for failure in failures]
    if failures:
        lines.append(f'the files are in {folder}')
    else:
        shutil.rmtree(folder)
    sys.stdout.write('\n'.join([*lines, '']))
    return int(bool(failures))


if __name__ == '__main__':
    code = main()
    sys.stdout.flush()
    os._exit(code)
