"""Commands that look at stimuli and records."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from functools import partial
from pathlib import Path
from types import ModuleType

import click

from blocks_planning.board.pictures import read_file
from blocks_planning.board.stimuli import installed_sets
from blocks_planning.cli.interrupt import interruptible
from blocks_planning.cli.options import (
    find_all,
    json_option,
    library_option,
    stimuli_argument,
    task_of,
)
from blocks_planning.errors import ConfigurationError, RecordError
from blocks_planning.trials.reading import read_records
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus

_RECORD = click.Path(path_type=Path, exists=False)


@click.group(
    invoke_without_command=True,
    epilog='\b\nExamples:\n  blocks-planning stimuli\n  blocks-planning stimuli show cogsci2021/9',
)
@click.pass_context
def stimuli(context: click.Context) -> None:
    """List the sets of silhouettes that ship with the package."""
    if context.invoked_subcommand is None:
        for name, path in installed_sets().items():
            silhouettes = read_file(path)
            sizes = sorted({f'{board.width}x{board.height}' for board, _ in silhouettes.values()})
            click.echo(f'{name}: {len(silhouettes)} silhouettes, {", ".join(sizes)} cells')


@stimuli.command(epilog='\b\nExample:\n  blocks-planning stimuli show cogsci2021/9')
@stimuli_argument
def show(addresses: tuple[str, ...]) -> None:
    """Draw silhouettes."""
    for index, stimulus in enumerate(find_all(addresses)):
        click.echo('\n' * bool(index) + f'# {stimulus.name}\n\n{stimulus.draw()}')


@click.command(epilog='\b\nExample:\n  blocks-planning count cogsci2021 --depth 5 --json')
@stimuli_argument
@click.option('--depth', type=click.IntRange(1, 64), default=4, show_default=True)
@library_option
@json_option
def count(addresses: tuple[str, ...], depth: int, library: str, as_json: bool) -> None:
    """Count the states that a breadth-first search evaluates.

    The numbers are tree nodes at depths 1 to n, summed, for n = 1 to --depth, from the empty
    board: what bfs evaluates when it finds nothing.
    """
    from blocks_planning.search.compiled import count_states

    for stimulus in find_all(addresses):
        task = task_of(stimulus, library)
        counts, interrupted = interruptible(partial(count_states, task, depth))
        if interrupted:
            raise KeyboardInterrupt
        if as_json:
            click.echo(json.dumps({'stimulus': stimulus.name, 'counts': counts}))
        else:
            click.echo(f'{stimulus.name}: ' + '  '.join(f'{number:,}' for number in counts or []))


@click.command(epilog='\b\nExample:\n  blocks-planning exact cogsci2021/9 --json')
@stimuli_argument
@library_option
@json_option
def exact(addresses: tuple[str, ...], library: str, as_json: bool) -> None:
    """Find the fewest blocks, and the number of arrangements, or prove that there are none."""
    from blocks_planning.search.exact import analyse

    for stimulus in find_all(addresses):
        task = task_of(stimulus, library)
        answer, interrupted = interruptible(partial(analyse, task))
        if interrupted or answer is None:
            raise KeyboardInterrupt
        if as_json:
            found = {
                'stimulus': stimulus.name,
                'fewest_blocks': answer.fewest_blocks,
                'arrangements': answer.arrangements,
                'by_rows': answer.by_rows,
                'placements': answer.placements,
            }
            click.echo(json.dumps(found))
            continue
        fewest = 'impossible' if answer.fewest_blocks is None else f'{answer.fewest_blocks} blocks'
        rows = ' '.join('-' if number is None else str(number) for number in answer.by_rows)
        click.echo(
            f'{stimulus.name}: {fewest}, {answer.arrangements:,} arrangements; '
            f'by number of rows: {rows}'
        )


@click.command(
    epilog='\b\nExamples:\n  blocks-planning verify records.jsonl --rerun\n'
    '  blocks-planning verify results/bag'
)
@click.argument('paths', metavar='RECORD...', type=_RECORD, nargs=-1, required=True)
@click.option('--rerun', is_flag=True, help='Also run every trial again and compare.')
def verify(paths: tuple[Path, ...], rerun: bool) -> int:
    """Replay the placements of records through the rules, and recompute their decisions.

    A RECORD is a file of records, or a bag: its trials are rebuilt from the messages alone, and
    held against what was said at their end. A bag that was cut off is repaired first.

    The exit code is 1 if something in a record does not follow from the rest.
    """
    from blocks_planning.trials.verify import differs_from_rerun

    wrong = 0
    for path in paths:
        read = _complaints_of_bag if _is_bag(path) else _complaints_of_file
        count = 0
        for record, complaints in read(path):
            sentences = list(complaints)
            place = str(path)
            if record is not None:
                count += 1
                place = f'{path}, record {count} ({record.spec.stimulus!r})'
                ended = record.status is not TrialStatus.BUILDING
                if rerun and ended and not sentences:
                    sentences = list(differs_from_rerun(record))
            wrong += bool(sentences)
            for sentence in sentences:
                click.echo(f'{place}: {sentence}')
        click.echo(f'{path}: {count} records read')
    click.echo('all hold' if not wrong else f'{wrong} do not hold')
    return int(bool(wrong))


_Complaints = Iterator[tuple[TrialRecord | None, Iterable[str]]]


def _complaints_of_file(path: Path) -> _Complaints:
    """The records of a file, each with what does not hold."""
    from blocks_planning.trials.verify import contradictions

    for record in read_records(path):
        yield record, contradictions(record)


def _complaints_of_bag(path: Path) -> _Complaints:
    """The records of a bag, each with what does not hold; None for what belongs to no record."""
    bags = _import_bags(path)
    for repair in bags.repair(path):
        click.echo(repair)
    refused: list[str] = []
    for number, trial in enumerate(bags.trials_of(path, refused.append), start=1):
        if not trial.is_over:
            stimulus = trial.record.spec.stimulus
            click.echo(f'{path}, record {number} ({stimulus!r}): its end is not in the bag')
        yield trial.record, trial.contradictions()
    for sentence in refused:
        yield None, [sentence]


def _is_bag(path: Path) -> bool:
    if path.is_dir():
        return (path / 'metadata.yaml').exists() or any(path.glob('*.mcap*'))
    return path.suffix in ('.mcap', '.db3')


def _import_bags(path: Path) -> ModuleType:
    """What reads bags.

    Raises:
        ConfigurationError: if the interfaces, or what reads MCAP, are not installed.
    """
    try:
        from blocks_planning.ros.bagging import bags
    except ModuleNotFoundError as error:
        missing = str(error.name).partition('.')[0]
        raise ConfigurationError(
            f'{path}: is a bag, and to read it {missing} has to be installed'
        ) from None
    return bags


@click.command(
    epilog='\b\nExamples:\n  blocks-planning draw record.json --out tower.png\n'
    '  blocks-planning draw records.jsonl --record 3 --out tower.gif\n'
    '  blocks-planning draw results/bag --record 3 --out tower.gif'
)
@click.argument('path', metavar='RECORD', type=_RECORD)
@click.option('--out', required=True, type=_RECORD, help='A .png, .svg, .pdf or .gif file.')
@click.option('--record', 'number', type=click.IntRange(1), help='Which one of several, from 1.')
def draw(path: Path, out: Path, number: int | None) -> None:
    """Draw the tower of a record, or of a trial in a bag; as .gif, block by block."""
    from blocks_planning.view.picture import save_picture

    if _is_bag(path):
        records = [trial.record for trial in _import_bags(path).trials_of(path)]
    else:
        records = read_records(path)
    save_picture(_one_of(records, path, number), out)


def _one_of(records: list[TrialRecord], path: Path, number: int | None) -> TrialRecord:
    if number is None and len(records) > 1:
        raise RecordError(f'{path}: has {len(records)} records; say which with --record')
    if number is not None and number > len(records):
        raise RecordError(f'{path}: has {len(records)} records, there is no record {number}')
    if not records:
        raise RecordError(f'{path}: has no trial')
    return records[(number or 1) - 1]
