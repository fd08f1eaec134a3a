"""What is declared, pinned and installed is what the sources need."""

from __future__ import annotations

import importlib
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

import pytest
import yaml
from declared import LOCKS, NAMES, canonical, pins, setup_arguments
from source_imports import PACKAGE, ROOT, imports, package_sources

import blocks_planning

BUILT_HERE = {'blocks_planning_msgs'}
ONLY_WITH_ROS = {'tf2_msgs'}
"""Without a wheel; what needs it says that it is missing."""

MANIFEST = ElementTree.parse(ROOT / 'package.xml').getroot()
MESSAGES = ROOT / 'msg_defs'
MESSAGES_MANIFEST = ElementTree.parse(MESSAGES / 'package.xml').getroot()
INTERFACES = sorted(
    path.relative_to(MESSAGES)
    for path in MESSAGES.rglob('*')
    if path.suffix in {'.msg', '.srv', '.action'}
)
SHARED = sorted(
    path.relative_to(ROOT)
    for folder in ('stimuli', 'config', 'launch')
    for path in (ROOT / folder).rglob('*')
    if path.is_file() and '__pycache__' not in path.parts
)


def declared_in_manifest(kind: str) -> set[str]:
    return {element.text or '' for element in MANIFEST.iter(kind)}


def third_party() -> list[str]:
    tops = {name.split('.')[0] for source in package_sources() for name, _ in imports(source)}
    return sorted(tops - set(sys.stdlib_module_names) - {PACKAGE})


@pytest.fixture(scope='module')
def arguments() -> dict[str, Any]:
    """What setup.py says to setuptools."""
    return setup_arguments()


@pytest.fixture(scope='module')
def prefix(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the package, installed the way colcon installs an ament_python package."""
    folder = tmp_path_factory.mktemp('packaging')
    copy = folder / 'source'
    for name in ('setup.py', 'setup.cfg', 'package.xml', 'README.md', 'LICENSE'):
        copy.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, copy / name)
    for name in ('blocks_planning', 'resource', 'stimuli', 'config', 'launch'):
        if (ROOT / name).is_dir():
            ignored = shutil.ignore_patterns('__pycache__')
            shutil.copytree(ROOT / name, copy / name, ignore=ignored)
    command = [sys.executable, 'setup.py', '--quiet', 'install', f'--prefix={folder / "prefix"}']
    command += ['--single-version-externally-managed', f'--record={folder / "record"}']
    done = subprocess.run(command, cwd=copy, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return folder / 'prefix'


@pytest.mark.parametrize(
    ('tag', 'argument'),
    [
        ('name', 'name'),
        ('version', 'version'),
        ('license', 'license'),
        ('maintainer', 'maintainer'),
    ],
)
def test_manifest_agrees_with_setup(arguments: dict[str, Any], tag: str, argument: str) -> None:
    assert MANIFEST.findtext(tag) == arguments[argument]


def test_version_is_that_of_the_package(arguments: dict[str, Any]) -> None:
    assert arguments['version'] == blocks_planning.__version__


@pytest.mark.parametrize(
    ('manifest', 'build_type'), [(MANIFEST, 'ament_python'), (MESSAGES_MANIFEST, 'ament_cmake')]
)
def test_manifest_names_its_build(manifest: ElementTree.Element, build_type: str) -> None:
    assert manifest.get('format') == '3'
    assert manifest.findtext('export/build_type') == build_type
    # colcon takes a package whose maintainer's address is no address for plain Python.
    [maintainer] = manifest.iter('maintainer')
    assert re.fullmatch(r'[\w.+-]+@[\w-]+(\.[\w-]+)+', maintainer.get('email', ''))


@pytest.mark.parametrize('tag', ['version', 'license', 'maintainer'])
def test_both_manifests_agree(tag: str) -> None:
    assert MESSAGES_MANIFEST.findtext(tag) == MANIFEST.findtext(tag)


@pytest.mark.parametrize('module', third_party())
def test_imported_module_is_declared_and_pinned(arguments: dict[str, Any], module: str) -> None:
    distribution, key = NAMES.get(module, (canonical(f'ros-{module}'), module))
    if key is not None:
        assert key in declared_in_manifest('exec_depend') | declared_in_manifest('depend')
    if module in NAMES:
        extras = arguments['extras_require']
        tiers = [*arguments['install_requires'], *extras['all'], *extras['robot']]
        assert distribution in map(canonical, tiers)
    if module not in BUILT_HERE | ONLY_WITH_ROS:
        assert distribution in pins(*LOCKS)


def test_installed_requirements_are_in_the_manifest(arguments: dict[str, Any]) -> None:
    keys = dict(NAMES.values())
    wanted = [*arguments['install_requires'], *arguments['extras_require']['all']]
    declared = {keys[canonical(text)] for text in wanted}
    assert declared - {None} <= declared_in_manifest('exec_depend')
    # What rosdep can't install is named in a comment.
    manifest = (ROOT / 'package.xml').read_text(encoding='utf-8')
    comments = ' '.join(re.findall(r'<!--(.*?)-->', manifest, re.DOTALL))
    unknown = {canonical(text) for text in wanted if keys[canonical(text)] is None}
    assert unknown
    assert {name for name in unknown if name not in comments} == set()


class Line(NamedTuple):
    """One field or constant of an interface, and the comment at its end."""

    type: str
    name: str
    comment: str
    is_constant: bool

    @property
    def base(self) -> str:
        """The type without its array's size or string's length."""
        return re.split(r'[\[<]', self.type)[0]


def interface_lines(path: Path) -> list[Line]:
    found = []
    for text in (MESSAGES / path).read_text(encoding='utf-8').splitlines():
        code, _, comment = text.partition('#')
        if code.strip() and code.strip() != '---':
            match = re.match(r'(\S+)\s+(\w+)\s*(=?)', code)
            assert match, text
            found.append(Line(match[1], match[2], comment.strip(), match[3] == '='))
    return found


@pytest.mark.parametrize('path', INTERFACES, ids=str)
def test_interface_says_what_its_fields_are(path: Path) -> None:
    assert (MESSAGES / path).read_text(encoding='utf-8').startswith('# ')
    lines = interface_lines(path)
    # A message as a field says what it is in its own file. The trial's name, in all of them, is
    # explained in one.
    of_a_trial = {'trial_id'} if path.name != 'TrialSpec.msg' else set()
    bare = {line.name for line in lines if line.base.islower() and '/' not in line.base}
    bare -= {line.name for line in lines if line.comment or line.is_constant} | of_a_trial
    assert bare == set()
    # What a constant is for, the field that holds it says.
    said = ' '.join(line.comment for line in lines)
    for line in lines:
        if line.is_constant:
            assert f'{line.name.split("_")[0]} constant' in said, line.name


@pytest.mark.parametrize('path', INTERFACES, ids=str)
def test_constant_of_an_interface_is_named_like_its_value(path: Path) -> None:
    text = (MESSAGES / path).read_text(encoding='utf-8')
    for name, value in re.findall(r'^string [A-Z]+_(\w+) = "(\w*)"', text, re.MULTILINE):
        assert name.lower() == value


def test_all_interfaces_are_built() -> None:
    text = (MESSAGES / 'CMakeLists.txt').read_text(encoding='utf-8')
    assert re.findall(r'^  ((?:msg|srv|action)/\S+)$', text, re.MULTILINE) == [
        path.as_posix() for path in INTERFACES
    ]


def test_packages_of_nested_types_are_declared() -> None:
    bases = {line.base for path in INTERFACES for line in interface_lines(path)}
    used = {base.partition('/')[0] for base in bases if '/' in base}
    assert 'std_msgs' in used
    assert used <= {element.text for element in MESSAGES_MANIFEST.iter('depend')}
    text = (MESSAGES / 'CMakeLists.txt').read_text(encoding='utf-8')
    [depends] = re.findall(r'^  DEPENDENCIES (.*)$', text, re.MULTILINE)
    assert set(depends.split()) == used
    assert set(re.findall(r'^find_package\((\w+) REQUIRED\)$', text, re.MULTILINE)) >= used


def test_colcon_is_told_where_all_packages_are() -> None:
    defaults = yaml.safe_load((ROOT / 'colcon_defaults.yaml').read_text(encoding='utf-8'))
    packages = {path.parent for path in tracked_files() if path.name == 'package.xml'}
    assert packages == {ROOT, MESSAGES}
    for verb in ('build', 'test', 'list', 'graph', 'info'):
        assert {ROOT / path for path in defaults[verb]['base-paths']} == packages
    [included] = defaults['build']['cmake-args']
    assert (MESSAGES / included.partition('=')[2]).is_file()


@pytest.mark.parametrize('path', SHARED, ids=str)
def test_shared_file_is_installed(prefix: Path, path: Path) -> None:
    installed = prefix / 'share' / PACKAGE / path
    assert installed.read_bytes() == (ROOT / path).read_bytes()


@pytest.mark.parametrize(
    'path',
    [
        f'share/ament_index/resource_index/packages/{PACKAGE}',
        f'share/{PACKAGE}/package.xml',
        f'lib/{PACKAGE}/blocks-planning',
    ],
)
def test_ros_tools_find_the_installed_package(prefix: Path, path: str) -> None:
    assert (prefix / path).is_file()


def test_all_of_the_package_is_installed(prefix: Path) -> None:
    [init] = prefix.glob(f'**/{PACKAGE}/__init__.py')
    there = {path.relative_to(init.parent) for path in init.parent.rglob('*')}
    package = ROOT / PACKAGE
    here = {path.relative_to(package) for path in package.rglob('*.py')} | {Path('py.typed')}
    here |= {path.relative_to(package) for path in package.glob('view/*/static/*')}
    assert here - there == set()


def test_console_scripts_can_be_called(arguments: dict[str, Any]) -> None:
    scripts = arguments['entry_points']['console_scripts']
    assert scripts
    for script in scripts:
        module, _, function = script.partition('=')[2].strip().partition(':')
        assert callable(getattr(importlib.import_module(module), function)), script


def tracked_files() -> list[Path]:
    """All files that are, or are about to be, under version control."""
    command = ['git', 'ls-files', '-z', '--cached', '--others', '--exclude-standard']
    if shutil.which('git') is None or not (ROOT / '.git').exists():
        pytest.skip('not a git checkout')
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return [ROOT / name for name in listed.split('\0') if name and (ROOT / name).is_file()]


@pytest.mark.parametrize(
    'forbidden',
    [
        # Written in pieces, because this file is read too.
        'py' + 'pi.org',
        'python' + 'hosted.org',
        'index' + '-url',
        'registry.npm' + 'js',
        '/wo' + 'rk/',
        '/ro' + 'ot/',
        '.py' + 'env/versions',
    ],
)
def test_no_address_of_a_registry_and_no_path_of_one_machine(forbidden: str) -> None:
    found = [
        f'{path.relative_to(ROOT)}:{number}'
        for path in tracked_files()
        for number, line in enumerate(path.read_bytes().decode(errors='replace').splitlines(), 1)
        if forbidden in line.lower()
    ]
    assert found == []


@pytest.mark.parametrize('table', ['tool.pytest.ini_options', 'tool.ruff', 'tool.mypy'])
def test_tool_is_configured(table: str) -> None:
    assert f'[{table}]' in (ROOT / 'pyproject.toml').read_text(encoding='utf-8').splitlines()


def test_metadata_stands_in_setup_only() -> None:
    text = (ROOT / 'pyproject.toml').read_text(encoding='utf-8')
    assert not re.search(r'^\[project\b', text, re.MULTILINE)
