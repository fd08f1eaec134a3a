"""Long names of towers and people in narrow columns."""

from __future__ import annotations

import re

from rich.cells import cell_len, chop_cells

_PART = re.compile(r'[^/_.\s-]*[/_.\s-]*')


def broken(name: str, width: int) -> str:
    """A name on as many lines as needed, broken after '/', '-', '_', '.' and blanks.

    Only a part that is longer than a line is broken inside. Nothing is omitted.

    Args:
        name: such as an address.
        width: of a line, at least 1 [terminal columns].
    """
    lines = ['']
    for part in _PART.findall(name):
        for piece in chop_cells(part, width) if cell_len(part.rstrip()) > width else [part]:
            if cell_len((lines[-1] + piece).rstrip()) <= width:
                lines[-1] += piece
            else:
                lines.append(piece)
    return '\n'.join(line for line in lines if line)
