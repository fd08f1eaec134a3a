"""The ``blocks-planning`` command as tests call it."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from blocks_planning.trials.reading import record_from_json

COMMAND = [sys.executable, '-m', 'blocks_planning.cli']
DEADLINE_S = 60


class Done(NamedTuple):
    """How a command ended."""

    code: object
    out: str
    err: str


Run = Callable[..., Done]


def draw_towers(path: Path, **pictures: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    parts = (f'tower {name}\n{rows}\n' for name, rows in pictures.items())
    path.write_text('\n'.join(parts).replace('/', '\n'))


def subprocess_run(*arguments: object, **settings: Any) -> subprocess.CompletedProcess[str]:
    """The command as a process of its own."""
    command = [*COMMAND, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE_S, **settings)


def read_back(text: str) -> list[Any]:
    """The records of a text, one in a line."""
    return [record_from_json(json.loads(line), 'stdout') for line in text.splitlines()]
