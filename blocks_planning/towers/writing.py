"""Generated towers as text pictures with their measures above them."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import fmean

from blocks_planning.board.pictures import format_silhouette
from blocks_planning.towers.making import Made


def format_set(name: str, towers: Sequence[Made], comments: Sequence[str] = ()) -> str:
    """A file of towers, named NAME-1, NAME-2, ...

    Args:
        name: of the set.
        towers: in order.
        comments: lines for the head of the file, such as the recipe.
    """
    head = [f'# {line}' for line in comments]
    head.append(f'# {len(towers)} towers; means: {_in_words(means_of(towers))}')
    pictures = [
        format_silhouette(
            f'{name}-{number}', tower.board, tower.silhouette, [_in_words(dict(tower.measures))]
        )
        for number, tower in enumerate(towers, start=1)
    ]
    return '\n'.join(['\n'.join([*head, '']), *pictures])


def means_of(towers: Sequence[Made]) -> dict[str, float]:
    """The mean of every measure that all towers have."""
    names = [name for name in towers[0].measures if all(name in t.measures for t in towers)]
    return {name: fmean(tower.measures[name] for tower in towers) for name in names}


def _in_words(measures: dict[str, float]) -> str:
    return ', '.join(
        f'{name} {value:,.2f}'.removesuffix('.00') for name, value in measures.items()
    )
