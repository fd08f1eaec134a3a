"""The distributions hold what an installation needs, and a package index would take them."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
from source_imports import PACKAGE, ROOT

NEEDED = ('setup.py', 'setup.cfg', 'pyproject.toml', 'package.xml', 'MANIFEST.in', 'README.md')
FOLDERS = (PACKAGE, 'resource', 'stimuli', 'config', 'launch')


def files_of(*folders: str) -> set[str]:
    """The files of some folders of the checkout, as their distribution names them."""
    found = (path for folder in folders for path in (ROOT / folder).rglob('*') if path.is_file())
    return {p.relative_to(ROOT).as_posix() for p in found if '__pycache__' not in p.parts}


@pytest.fixture(scope='module')
def distributions(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with an sdist, and the wheel that was built from it."""
    folder = tmp_path_factory.mktemp('distribution')
    source = folder / 'source'
    for name in FOLDERS:
        shutil.copytree(ROOT / name, source / name, ignore=shutil.ignore_patterns('__pycache__'))
    for name in (*NEEDED, 'LICENSE'):
        shutil.copy(ROOT / name, source / name)
    command = [sys.executable, '-m', 'build', '--no-isolation', '--outdir', str(folder / 'dist')]
    done = subprocess.run([*command, str(source)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / 'dist'


@pytest.mark.long
def test_sdist_holds_what_builds_the_package(distributions: Path) -> None:
    [path] = distributions.glob('*.tar.gz')
    with tarfile.open(path) as archive:
        there = {name.partition('/')[2] for name in archive.getnames()}
    assert files_of(*FOLDERS) | set(NEEDED) | {'LICENSE'} <= there


@pytest.mark.long
def test_wheel_built_from_it_holds_the_package_and_its_data(distributions: Path) -> None:
    [path] = distributions.glob('*.whl')
    there = set(zipfile.ZipFile(path).namelist())
    assert files_of(PACKAGE) <= there
    [data] = {name.partition('/')[0] for name in there if '.data/' in name}
    shared = files_of('stimuli', 'config', 'launch') | {'package.xml'}
    assert {f'{data}/data/share/{PACKAGE}/{name}' for name in shared} <= there


@pytest.mark.long
def test_index_would_take_them(distributions: Path) -> None:
    paths = sorted(str(path) for path in distributions.iterdir())
    assert len(paths) == 2
    command = [sys.executable, '-m', 'twine', 'check', '--strict', *paths]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    assert done.stdout.count('PASSED') == 2


@pytest.mark.long
def test_installed_wheel_finds_its_data_anywhere(distributions: Path, tmp_path: Path) -> None:
    [path] = distributions.glob('*.whl')
    target = tmp_path / 'installed here'
    command = [sys.executable, '-m', 'pip', 'install', '--quiet', '--no-deps', '--no-index']
    subprocess.run([*command, '--target', str(target), str(path)], check=True)
    code = f"""
import sys
sys.path.insert(0, {str(target)!r})
from {PACKAGE} import resources
print(*resources.resource_directories('config'), sep='\\n')
from {PACKAGE}.cli import main
sys.argv = ['blocks-planning', 'solve', 'cogsci2021/9', '--json']
main()
"""
    command = [sys.executable, '-c', code]
    environment = {k: v for k, v in os.environ.items() if k != 'AMENT_PREFIX_PATH'}
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, env=environment)
    assert done.stdout.splitlines()[0] == str(target / 'share' / PACKAGE / 'config')
    assert '"status":"success"' in done.stdout, done.stderr
