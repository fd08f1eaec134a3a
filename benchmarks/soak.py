"""A long run through one graph: what every node takes at its start, in its middle, at its end.

Grown is what is larger at the end than in the middle by more than noise: the first half may fill
caches, the second has nothing left to fill.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import click
import yaml

from benchmarks.processes import Taken, process, resources

MOMENTS = {'start': 0.02, 'middle': 0.5, 'end': 0.98}
MEMORY_NOISE_MB = 4.0
MEMORY_NOISE_PART = 0.03
_LOOK_S = 0.5
_STALL_S = 120.0


@click.command()
@click.option('--trials', default=20_000, show_default=True, type=click.IntRange(160))
@click.option('--out', default='benchmarks/soak.json', type=click.Path(path_type=Path))
def main(trials: int, out: Path) -> None:
    """Run so many trials through one graph, and say whether anything grew."""
    seeds = trials // 16
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder, 'script.yaml')
        script.write_text(yaml.safe_dump(_script(seeds)), encoding='utf-8')
        command = [sys.executable, '-m', 'blocks_planning.cli', 'run', str(script)]
        command += ['--out', folder, '--bag', f'{folder}/bag']
        begun = time.monotonic()
        with process(command) as running:
            taken = {}
            for moment, part in MOMENTS.items():
                for count in _records(Path(folder, 'trials.jsonl')):
                    if running.poll() is not None:
                        raise SystemExit(f'the graph ended with {running.returncode}')
                    if count >= part * 16 * seeds:
                        break
                taken[moment] = resources(running.pid)
            seconds = time.monotonic() - begun
    grown = list(growth(taken['middle'], taken['end']))
    print(f'{count} trials in {seconds:.0f} s, {count / seconds:.1f} per second\n')
    for line in _table(taken):
        print(line)
    print('\n' + ('\n'.join(grown) or 'nothing grew'))
    results = {
        'trials': count,
        'seconds': round(seconds, 1),
        'taken': {m: {n: t._asdict() for n, t in nodes.items()} for m, nodes in taken.items()},
        'grown': grown,
    }
    out.write_text(json.dumps(results, indent=1) + '\n', encoding='utf-8')
    print(f'\nwritten to {out}')
    sys.exit(bool(grown))


def _script(seeds: int) -> dict[str, object]:
    return {
        'stimuli': ['cogsci2021'],
        'seeds': seeds,
        'searches': [{'name': 'bfs', 'depth': 3}],
        'strategies': [{'name': 'scoping', 'lambda': 0.002}],
    }


def _records(path: Path) -> Iterator[int]:
    """The number of records, again and again.

    Raises:
        SystemExit: if no more come.
    """
    count, offset, news = 0, 0, time.monotonic()
    while True:
        if path.exists():
            with path.open('rb') as file:
                file.seek(offset)
                data = file.read()
            offset += len(data)
            count += data.count(b'\n')
            news = time.monotonic() if data else news
        if time.monotonic() - news > _STALL_S:
            raise SystemExit(f'no record in {_STALL_S:.0f} s, after {count}')
        yield count
        time.sleep(_LOOK_S)


def growth(middle: dict[str, Taken], end: dict[str, Taken]) -> Iterator[str]:
    """Everything that takes more at the end than in the middle, a sentence each."""
    if set(middle) != set(end):
        yield f'not the same processes: {sorted(middle)}, then {sorted(end)}'
    for name in sorted(set(middle) & set(end)):
        for field, before, after in zip(Taken._fields, middle[name], end[name], strict=True):
            noise = 0.0
            if field in ('memory', 'shared'):
                noise = max(MEMORY_NOISE_MB, MEMORY_NOISE_PART * before)
            if after - before > noise:
                yield f'{name}: {field} grew from {before:.1f} to {after:.1f}'


def _table(taken: dict[str, dict[str, Taken]]) -> Iterator[str]:
    heads = ('memory [MB]', 'threads', 'files', 'shared [MB]')
    yield f'{"":<20}' + ''.join(f'{head:>27}' for head in heads)
    yield f'{"":<20}' + ''.join(f'{moment:>9}' for _ in heads for moment in taken)
    for name in taken['start']:
        cells = [
            taken[moment][name][column] if name in taken[moment] else float('nan')
            for column in range(len(heads))
            for moment in taken
        ]
        yield f'{name:<20}' + ''.join(f'{cell:>9.4g}' for cell in cells)


if __name__ == '__main__':
    main()
