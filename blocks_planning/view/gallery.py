"""A picture of each of the first trials of a run, in one folder."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from rich.console import Console
from rich.text import Text

from blocks_planning.errors import ConfigurationError
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.view.picture import save_picture

_STIMULUS_CHARACTERS = 60
_UNFIT = re.compile(r'[^A-Za-z0-9._]+')


class Gallery(NamedTuple):
    """The drawn pictures; ``left_out`` is the number of trials without one."""

    folder: Path
    paths: tuple[Path, ...]
    left_out: int


def save_gallery(records: Sequence[TrialRecord], folder: Path, most: int) -> Gallery:
    """Draw up to ``most`` trials as SVG; existing pictures are replaced.

    Raises:
        ConfigurationError: if the folder or a picture can't be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ConfigurationError(f'{folder}: cannot be written: {error.strerror}') from None
    names = _names(record.spec for record in records)
    paths = tuple(folder / f'{name}.svg' for name in islice(names, most))
    for record, path in zip(records, paths, strict=False):
        save_picture(record, path)
    return Gallery(folder, paths, len(records) - len(paths))


def print_gallery(gallery: Gallery, console: Console | None = None) -> None:
    """Print where the pictures are; with a link to each, if the terminal supports links."""
    console = console or Console()
    folder = Text('Pictures: ')
    folder.append(str(gallery.folder), style=_link(gallery.folder))
    if gallery.left_out:
        drawn = len(gallery.paths)
        folder.append(f' (of the first {drawn} trials; {gallery.left_out:,} left out)')
    console.print(folder, soft_wrap=True, highlight=False)
    if console.is_terminal and console.color_system is not None:
        names = (Text(path.stem, style=_link(path)) for path in gallery.paths)
        console.print(Text('  ').join(names), highlight=False)


def _link(path: Path) -> str:
    return f'link {path.resolve().as_uri()}'


def _names(specs: Iterator[TrialSpec]) -> Iterator[str]:
    """A file name for each trial, without suffix: stimulus, strategy, search and seed."""
    seen: set[str] = set()
    for spec in specs:
        stimulus = _UNFIT.sub('-', spec.stimulus)[-_STIMULUS_CHARACTERS:].strip('-.')
        name = f'{stimulus}-{spec.strategy.name}-{spec.search.name}-seed{spec.seed}'
        if name in seen:  # such as another lambda: settings are not in the name
            name = f'{name}-{spec.trial_id[:8]}'
        seen.add(name)
        yield name
