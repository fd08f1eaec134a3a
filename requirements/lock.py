"""Write lock.txt: what the lists in this folder resolve to on every supported Python.

    python requirements/lock.py python3.10 python3.11 python3.12 python3.13

Each interpreter's own pip resolves the lists as for an empty environment. A line without a
marker holds for all of them. A frozen environment would not do as a source: the ROS wheels
leave metadata of packages that no registry has.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
HEADER = """\
# Every package of the development environment, direct and indirect, at one exact version.
# Written by lock.py from the *.in files beside it: edit those, then run it again.
"""


def resolve(python: str) -> tuple[tuple[int, int], dict[str, str]]:
    """Ask `python` for its version and for what its pip would install."""
    code = 'import sys; print(*sys.version_info[:2])'
    found = subprocess.run([python, '-c', code], check=True, capture_output=True, text=True)
    major, minor = map(int, found.stdout.split())
    command = [python, '-m', 'pip', 'install', '--dry-run', '--ignore-installed', '--quiet']
    # Wheels only, so that no old source release wins; empy has none.
    command += ['--only-binary=:all:', '--no-binary=empy']
    for path in sorted(HERE.glob('*.in')):
        command += ['--requirement', str(path)]
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder, 'report.json')
        subprocess.run([*command, '--report', str(report)], check=True)
        installs = json.loads(report.read_text())['install']
    packages = [item['metadata'] for item in installs]
    pins = {re.sub(r'[-_.]+', '-', p['name']).lower(): p['version'] for p in packages}
    return (major, minor), pins


def marker(have: set[tuple[int, int]], known: list[tuple[int, int]]) -> str:
    """Say in an environment marker which of the `known` versions of Python are meant."""
    parts = []
    if min(have) > known[0]:
        parts.append('python_version >= "{}.{}"'.format(*min(have)))
    if max(have) < known[-1]:
        parts.append('python_version < "{}.{}"'.format(*known[known.index(max(have)) + 1]))
    if len(have) != known.index(max(have)) - known.index(min(have)) + 1:
        raise SystemExit(f'a version holds for {sorted(have)} only, which is not one range')
    return '; ' + ' and '.join(parts) if parts else ''


def main(pythons: list[str]) -> None:
    """Resolve for all `pythons` and write the lock."""
    if not pythons:
        raise SystemExit(__doc__)
    resolved = dict(map(resolve, pythons))
    known = sorted(resolved)
    wanted: dict[tuple[str, str], set[tuple[int, int]]] = {}
    for python, pins in resolved.items():
        for pin in pins.items():
            wanted.setdefault(pin, set()).add(python)
    lines = [f'{n}=={v}{marker(have, known)}\n' for (n, v), have in sorted(wanted.items())]
    part = HERE / 'lock.txt.part'
    part.write_text(HEADER + ''.join(lines))
    part.replace(HERE / 'lock.txt')
    print(f'{len(lines)} lines for Python', ', '.join(f'{a}.{b}' for a, b in known))


if __name__ == '__main__':
    main(sys.argv[1:])
