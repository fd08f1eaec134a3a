"""The table of all settings in the documentation, generated from their descriptions.

python -m blocks_planning.trials.settings_table > docs/settings.md
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any

from blocks_planning.settings import Setting, described
from blocks_planning.subgoals.regions import REGIONS
from blocks_planning.trials.spec import FAMILIES

_HEAD = """\
# Settings

Every search, strategy, region family and world, with its settings. A setting is an option of the
command line (`--max-cells`), a key in scripts and sweeps (`max_cells`), part of the trial id, a
column of the tables, and a field of records and messages. The settings of a region family are
given together with those of the strategy that uses it.

This page is generated from the code:
`python -m blocks_planning.trials.settings_table > docs/settings.md`.
"""


def markdown() -> str:
    """The whole page."""
    return '\n'.join([_HEAD, *_sections()])


def _sections() -> Iterator[str]:
    for family, registry in {**FAMILIES, 'regions': REGIONS}.items():
        yield f'## {family}\n'
        for name, cls in registry.items():
            yield f'### {name}\n\n{_summary(cls)}\n'
            rows = [_row(known) for _, known in described(cls)]
            if rows:
                yield '| setting | values | default | unit | meaning |\n|---|---|---|---|---|'
                yield '\n'.join(rows) + '\n'


def _summary(cls: type[Any]) -> str:
    return (cls.__doc__ or '').strip().split('\n\n')[0].replace('\n    ', ' ')


def _row(known: Setting) -> str:
    default = f'`{known.default}`' if known.default != '' else 'empty'
    return (
        f'| `{known.name}` | {known.requirement} | {default} | {known.unit or "-"} '
        f'| {known.text} |'
    )


if __name__ == '__main__':
    sys.stdout.write(markdown())
