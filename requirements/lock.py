"""Write the locks: what the lists in this folder resolve to on every supported Python.

    python requirements/lock.py [options of `uv pip compile`, such as --upgrade-package numpy]

uv resolves all lists together, for CPython 3.10 and newer at once; a line with a marker holds
for some of them only. A version that is locked already stays, unless an option says otherwise.
Every file of a version has its hash. A frozen environment would not do as a source: the ROS
wheels leave metadata of packages that no registry has.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

HERE = Path(__file__).resolve().parent
LOCKS = {
    'lock-uv.txt': ('uv',),
    'lock.txt': ('runtime', 'figures', 'ros', 'build'),
    'lock-development.txt': ('experiments', 'page', 'development'),
    'lock-robot.txt': ('robot',),
}
"""The lists behind each lock. A package is in the first lock that needs it."""
HEADERS = {
    'lock-uv.txt': 'What installs the other locks.',
    'lock.txt': 'Every package that `make demo` needs, direct and indirect, at one exact version.',
    'lock-development.txt': 'What experiments, the page and development need beside lock.txt.',
    'lock-robot.txt': 'What the simulated robot needs beside the others.',
}
WRITTEN = 'Written by lock.py from the *.in files beside it: edit those, then run it again.'
OPTIONS = [
    *('--universal', '--python-version', '3.10', '--generate-hashes'),
    *('--no-annotate', '--no-header', '--no-config', '--quiet'),
    # Wheels only, so that no old source release wins; empy has none.
    *('--only-binary', ':all:', '--no-binary', 'empy'),
]
KEPT = {'UV_CACHE_DIR', 'UV_DEFAULT_INDEX', 'UV_NATIVE_TLS', 'UV_SYSTEM_CERTS'}
"""Settings of uv that say how to get packages; others would change which ones."""


def package_name(text: str) -> str:
    """The name in a requirement, in the one spelling that an index compares."""
    found = re.match(r'[A-Za-z0-9._-]+', text)
    if found is None:
        raise SystemExit(f'{text!r} does not begin with the name of a package')
    return re.sub(r'[-_.]+', '-', found.group()).lower()


def blocks(text: str) -> list[str]:
    """The requirements of a lock, each with the lines of its hashes."""
    found: list[str] = []
    for line in text.splitlines(keepends=True):
        if line.startswith('#'):
            continue
        if line.startswith(' '):
            found[-1] += line
        else:
            found.append(line)
    return found


def resolve(names: Iterable[str], locked: str, options: Iterable[str]) -> list[str]:
    """Ask uv for what lists resolve to; versions of the text `locked` are preferred."""
    lists = [str(HERE / f'{name}.in') for name in names]
    environment = {k: v for k, v in os.environ.items() if not k.startswith('UV_') or k in KEPT}
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder, 'lock.txt')
        output.write_text(locked, encoding='utf-8')
        command = [str(Path(sys.executable).with_name('uv')), 'pip', 'compile', *OPTIONS]
        command += [*options, '--python', sys.executable, '--output-file', str(output), *lists]
        done = subprocess.run(command, env=environment, check=False)
        if done.returncode:
            raise SystemExit(done.returncode)
        return blocks(output.read_text(encoding='utf-8'))


def main(options: list[str]) -> None:
    """Resolve and write all locks."""
    present = [HERE / name for name in LOCKS if (HERE / name).exists()]
    locked = ''.join(path.read_text(encoding='utf-8') for path in present)
    everything = resolve([name for names in LOCKS.values() for name in names], locked, options)
    placed: set[str] = set()
    for lock, lists in LOCKS.items():
        needed = {package_name(block) for block in resolve(lists, ''.join(everything), ())}
        chosen = [b for b in everything if package_name(b) in needed - placed]
        placed |= needed
        part = HERE / f'{lock}.part'
        head = f'# {HEADERS[lock]}\n# {WRITTEN}\n'
        part.write_text(head + ''.join(chosen), encoding='utf-8')
        part.replace(HERE / lock)
        print(f'{lock}: {len(chosen)} requirements')
    lost = {package_name(block) for block in everything} - placed
    if lost:
        raise SystemExit(f'in no lock: {", ".join(sorted(lost))}')


if __name__ == '__main__':
    main(sys.argv[1:])
