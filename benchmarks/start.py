"""What a user waits for: the first import, and the help text."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from statistics import median

from benchmarks.measure import Figure, seconds

COMMANDS = {
    'python -c pass': (['-c', 'pass'], ''),
    'import blocks_planning': (['-c', 'import blocks_planning'], '< 0.1 over an empty program'),
    'blocks-planning --help': (['-m', 'blocks_planning.cli', '--help'], '< 0.5'),
    'blocks-planning solve, one tower': (
        ['-m', 'blocks_planning.cli', 'solve', 'cogsci2021/9'],
        '',
    ),
}


def run(quick: bool) -> Iterator[Figure]:
    """Medians over several starts, everything compiled before."""
    for name, (arguments, target) in COMMANDS.items():
        command = [sys.executable, *arguments]
        start = partial(subprocess.run, command, check=True, capture_output=True)
        start()
        times = [seconds(start) for _ in range(3 if quick else 9)]
        yield Figure(name, median(times), 's', target)
