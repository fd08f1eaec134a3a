"""Silhouettes by address: the sets that ship with the package, and files of text pictures.

An *address* is ``SET`` (all silhouettes of an installed set, or of a file by its path) or
``SET/NAME`` (one of them), such as ``cogsci2021/9`` or ``my/towers.txt/arch``. The form of a
file is described in :mod:`.pictures`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from blocks_planning.board.geometry import FILLED, Board, Mask
from blocks_planning.board.names import normalised
from blocks_planning.board.pictures import read_file
from blocks_planning.errors import StimulusError, shown
from blocks_planning.resources import resource_directories

_MOST_SHOWN = 200
SUFFIX = '.txt'


@dataclass(frozen=True)
class Stimulus:
    """A silhouette with its address."""

    name: str
    board: Board
    silhouette: Mask

    def draw(self) -> str:
        """The picture in the form of a file."""
        return self.board.draw(self.silhouette)


def installed_sets() -> dict[str, Path]:
    """The sets that ship with the package, by name."""
    sets: dict[str, Path] = {}
    for directory in resource_directories('stimuli'):
        for path in sorted(directory.glob(f'*{SUFFIX}')):
            sets.setdefault(path.stem, path)
    return sets


def find_stimuli(address: str) -> list[Stimulus]:
    """The silhouettes that an address names, in the order of their file.

    Raises:
        StimulusError: if there is no such set, file or silhouette, or it can't be read or has
            no target cell.
    """
    stimuli = _find(address)
    for stimulus in stimuli:
        if not stimulus.silhouette:
            raise StimulusError(
                f'stimulus {shown(stimulus.name, _MOST_SHOWN)}: has no target cell, so there '
                f"is nothing to build; draw at least one '{FILLED}'"
            )
    return stimuli


def _find(address: str) -> list[Stimulus]:
    """The silhouettes of an address, empty ones included."""
    sets = installed_sets()
    whole = _file_of(address, sets)
    if whole is not None:
        silhouettes = read_file(whole)
        alone = address not in sets and list(silhouettes) == ['1']
        return [
            Stimulus(address if alone else f'{address}/{name}', *silhouette)
            for name, silhouette in silhouettes.items()
        ]
    head, _, item = address.rpartition('/')
    path = _file_of(head, sets) if head else None
    if path is None or not (head in sets or path.is_file()):
        raise StimulusError(
            f'stimulus {shown(address, _MOST_SHOWN)}: no such file, and no such set '
            f'(there are: {", ".join(sorted(sets)) or "none"}); '
            'expected SET, SET/NAME or a path'
        )
    silhouettes = read_file(path)
    item = normalised(item)
    if item not in silhouettes:
        raise StimulusError(
            f'stimulus {shown(address, _MOST_SHOWN)}: {path} has no tower {shown(item)}; '
            f'it has {_listing(silhouettes)}'
        )
    return [Stimulus(address, *silhouettes[item])]


def _file_of(address: str, sets: dict[str, Path]) -> Path | None:
    """The file of an address without a name, if there is one."""
    if address in sets:
        return sets[address]
    path = Path(address)
    try:
        return path if address and path.exists() else None
    except (OSError, ValueError):  # the address is too long for the file system, or contains a NUL
        return None


def _listing(names: Iterable[str], most: int = 20) -> str:
    listed = list(names)
    more = f' and {len(listed) - most} more' if len(listed) > most else ''
    return ', '.join(listed[:most]) + more
