"""Planning and the nodes need the first tier of packages alone; the rest says which extra it is."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterable, Iterator
from importlib import metadata
from importlib.util import find_spec
from pathlib import Path

import pytest
from declared import NAMES, REQUIREMENTS, canonical, pins, setup_arguments
from source_imports import PACKAGE, ROOT, Source, package_sources

from blocks_planning.extras import EXTRAS, MissingExtra, extra

EXTRA_OF = {
    module: name
    for name in EXTRAS
    for module, (distribution, _) in NAMES.items()
    if distribution in map(canonical, setup_arguments()['extras_require'][name])
}
"""The extra of each module that belongs to one."""
HIDE = """
import sys
hidden = set({hidden!r})
class Hidden:
    def find_spec(self, name, path=None, target=None):
        if name.partition('.')[0] in hidden:
            raise ModuleNotFoundError(f'No module named {{name!r}}', name=name)
sys.meta_path.insert(0, Hidden())
"""


def guards(source: Source) -> Iterator[tuple[str, str | None]]:
    """Every imported module of an extra, and the extra that its import is guarded with."""

    def visit(node: ast.AST, guard: str | None) -> Iterator[tuple[str, str | None]]:
        match node:
            case ast.With(items=[ast.withitem(ast.Call(ast.Name('extra'), [ast.Constant(name)]))]):
                guard = str(name)
            case ast.Import(names):
                yield from ((alias.name.partition('.')[0], guard) for alias in names)
            case ast.ImportFrom(str(module), _, 0):
                yield module.partition('.')[0], guard
        for child in ast.iter_child_nodes(node):
            yield from visit(child, guard)

    return ((module, guard) for module, guard in visit(ast.parse(source.text), None))


def needed_by(names: Iterable[str]) -> set[str]:
    """Distributions and everything that those need in turn, as far as it is installed."""
    found: set[str] = set()
    waiting = [canonical(name) for name in names]
    while waiting:
        name = waiting.pop()
        if name in found:
            continue
        try:
            requirements = metadata.requires(name) or []
        except metadata.PackageNotFoundError:
            continue
        found.add(name)
        plain = [text for text in requirements if 'extra ==' not in text.partition(';')[2]]
        waiting += map(canonical, plain)
    return found


def outside_of(allowed: set[str]) -> list[str]:
    """All importable modules of installed distributions that are not among the allowed ones."""
    return sorted(
        module
        for module, distributions in metadata.packages_distributions().items()
        if not allowed & set(map(canonical, distributions)) and module != PACKAGE
    )


def run_without(hidden: Iterable[str], code: str) -> subprocess.CompletedProcess[str]:
    """Run code in a Python of its own that can't import the hidden modules."""
    command = [sys.executable, '-c', HIDE.format(hidden=sorted(hidden)) + code]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True)


def first_tier() -> set[str]:
    """The distributions that planning and the nodes may use."""
    own = setup_arguments()['install_requires']
    return needed_by([*own, *pins(REQUIREMENTS / 'ros.in'), 'blocks-planning-msgs'])


def test_extras_are_those_of_setup() -> None:
    extras = setup_arguments()['extras_require']
    assert set(EXTRAS) == set(extras) - {'all', 'test'}
    assert sorted(extras['all']) == sorted(
        name for key in EXTRAS if key != 'robot' for name in extras[key]
    )
    assert set(EXTRA_OF.values()) == set(EXTRAS)


@pytest.mark.parametrize('source', package_sources(), ids=lambda source: source.module)
def test_import_of_an_extra_names_it(source: Source) -> None:
    for module, guard in guards(source):
        assert guard == EXTRA_OF.get(module), module


@pytest.mark.parametrize(
    ('text', 'found'),
    [
        ('import pandas as pd', ('pandas', None)),
        ("with extra('figures'):\n    from PIL import Image", ('PIL', 'figures')),
        ("def f():\n    with extra('page'):\n        import aiohttp.web", ('aiohttp', 'page')),
        ("with suppress('page'):\n    import aiohttp", ('aiohttp', None)),
    ],
)
def test_guard_is_seen(text: str, found: tuple[str, str | None]) -> None:
    assert list(guards(Source(f'{PACKAGE}.x', text))) == [found]


def test_missing_module_names_its_extra_and_what_to_do() -> None:
    with pytest.raises(MissingExtra) as raised, extra('figures'):
        import nowhere.to_be_found  # type: ignore[import-not-found]  # noqa: F401
    assert str(raised.value) == (
        "the module nowhere is not installed; it comes with the extra 'figures' of this package: "
        "pip install 'blocks_planning[figures]' (in a checkout: make setup)"
    )


@pytest.mark.parametrize(
    ('module', 'name', 'missing'),
    [
        ('view.picture', 'figures', 'matplotlib'),
        *(
            pytest.param(*case, marks=pytest.mark.long)
            for case in (
                ('experiments.store', 'experiments', 'pyarrow'),
                ('analysis.trials', 'experiments', 'pandas'),
                ('view.web.server', 'page', 'aiohttp'),
            )
        ),
    ],
)
def test_part_that_is_not_installed_says_so(module: str, name: str, missing: str) -> None:
    code = f"""
from importlib import import_module
from blocks_planning.errors import ConfigurationError
try:
    import_module('{PACKAGE}.{module}')
except ConfigurationError as error:
    print(error)
"""
    done = run_without(outside_of(first_tier()), code)
    assert done.stderr == ''
    assert done.stdout.startswith(
        f"the module {missing} is not installed; it comes with the extra '{name}'"
    )


def test_command_that_needs_an_extra_says_so_in_one_line(tmp_path: Path) -> None:
    code = f"""
from {PACKAGE}.cli import main
sys.argv = ['blocks-planning', 'growth', '--out', {str(tmp_path / 'out')!r}]
main()
"""
    done = run_without(outside_of(first_tier()), code)
    assert done.returncode == 2
    assert done.stderr.startswith('Error: the module ')
    assert done.stderr.count('\n') == 1
    assert not (tmp_path / 'out').exists()


def test_solving_needs_the_first_tier_alone() -> None:
    code = f"""
from {PACKAGE}.cli import main
sys.argv = ['blocks-planning', 'solve', 'cogsci2021/9', '--json']
main()
"""
    done = run_without(outside_of(first_tier()), code)
    assert '"status":"success"' in done.stdout, done.stderr


def test_every_node_can_be_imported_with_the_first_tier_alone() -> None:
    nodes = sorted(path.stem for path in (ROOT / PACKAGE / 'ros' / 'nodes').glob('[a-z]*.py'))
    assert len(nodes) >= 7
    code = f"""
from importlib import import_module
for name in {nodes!r}:
    import_module(f'{PACKAGE}.ros.nodes.{{name}}')
print('all')
"""
    done = run_without(outside_of(first_tier()), code)
    assert done.stdout == 'all\n', done.stderr


def test_the_first_tier_is_small() -> None:
    hidden = outside_of(first_tier())
    installed = [module for module in EXTRA_OF if find_spec(module) is not None]
    assert len(installed) > 5
    for module in (*installed, 'pytest', 'dask'):
        assert module in hidden
    for module in ('numpy', 'numba', 'yaml', 'click', 'rich', 'mcap', 'rosbags', 'rclpy'):
        assert module not in hidden
