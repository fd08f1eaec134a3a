"""Commands that check and draw records."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from types import ModuleType

import click

from blocks_planning.errors import ConfigurationError, RecordError
from blocks_planning.trials.reading import read_records
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus

_RECORD = click.Path(path_type=Path, exists=False)


@click.command(
    epilog='\b\nExamples:\n  blocks-planning verify records.jsonl --rerun\n'
    '  blocks-planning verify results/bag'
)
@click.argument('paths', metavar='RECORD...', type=_RECORD, nargs=-1, required=True)
@click.option('--rerun', is_flag=True, help='Also run every trial again and compare.')
def verify(paths: tuple[Path, ...], rerun: bool) -> int:
    """Check records: replay placements and recompute decisions.

    A RECORD is a file of records, or a bag. The trials of a bag are rebuilt from its messages
    alone, and compared with their recorded outcomes. A truncated bag is repaired first.

    The exit code is 1 if a record is inconsistent.
    """
    from blocks_planning.trials.verify import differs_from_rerun

    wrong = external = 0
    for path in paths:
        read = _complaints_of_bag if _is_bag(path) else _complaints_of_file
        count = 0
        for record, complaints in read(path):
            sentences = list(complaints)
            place = str(path)
            if record is not None:
                count += 1
                place = f'{path}, record {count} ({record.spec.stimulus!r})'
                external += record.spec.strategy.is_external
                ended = record.status is not TrialStatus.BUILDING
                if rerun and ended and not sentences:
                    sentences = list(differs_from_rerun(record))
            wrong += bool(sentences)
            for sentence in sentences:
                click.echo(f'{place}: {sentence}')
        click.echo(f'{path}: {count} records read')
    if external:
        click.echo(
            f'{external} records with the decisions of another program: choices not checked'
        )
    click.echo('all consistent' if not wrong else f'{wrong} inconsistent')
    return int(bool(wrong))


_Complaints = Iterator[tuple[TrialRecord | None, Iterable[str]]]


def _complaints_of_file(path: Path) -> _Complaints:
    """The records of a file, each with its contradictions."""
    from blocks_planning.trials.verify import contradictions

    for record in read_records(path):
        yield record, contradictions(record)


def _complaints_of_bag(path: Path) -> _Complaints:
    """The records of a bag, each with its contradictions; None for contradictions of no record."""
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
    """The module that reads bags.

    Raises:
        ConfigurationError: if the interfaces, or the MCAP reader, are not installed.
    """
    try:
        from blocks_planning.ros.bagging import bags
    except ModuleNotFoundError as error:
        missing = str(error.name).partition('.')[0]
        raise ConfigurationError(
            f'{path}: this is a bag; reading it needs {missing}, which is not installed'
        ) from None
    return bags


@click.command(
    epilog='\b\nExamples:\n  blocks-planning draw record.json --out tower.png\n'
    '  blocks-planning draw records.jsonl --record 3 --out tower.gif\n'
    '  blocks-planning draw results/bag --record 3 --out tower.gif'
)
@click.argument('path', metavar='RECORD', type=_RECORD)
@click.option('--out', required=True, type=_RECORD, help='A .png, .svg, .pdf or .gif file.')
@click.option(
    '--record', 'number', type=click.IntRange(1), help='Number of the record or trial, from 1.'
)
def draw(path: Path, out: Path, number: int | None) -> None:
    """Draw the tower of a record or of a trial in a bag.

    A .gif file shows the tower block by block.
    """
    from blocks_planning.view.picture import save_picture

    if _is_bag(path):
        records = [trial.record for trial in _import_bags(path).trials_of(path)]
    else:
        records = read_records(path)
    save_picture(_one_of(records, path, number), out)


def _one_of(records: list[TrialRecord], path: Path, number: int | None) -> TrialRecord:
    if number is None and len(records) > 1:
        raise RecordError(f'{path}: has {len(records)} records; choose one with --record')
    if number is not None and number > len(records):
        raise RecordError(f'{path}: has {len(records)} records; --record {number} is out of range')
    if not records:
        raise RecordError(f'{path}: has no trial')
    return records[(number or 1) - 1]
