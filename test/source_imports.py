"""Read from sources, without running them, what they import."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = 'blocks_planning'


class Source(NamedTuple):
    """One module: its dotted name, its text, and whether it is a package's __init__."""

    module: str
    text: str
    is_package: bool = False


class Import(NamedTuple):
    """One imported thing: absolute dotted name (with the imported name last) and its line."""

    name: str
    line: int


def package_sources() -> list[Source]:
    """All modules of the package, in the order of their names."""
    sources = []
    for path in sorted((ROOT / PACKAGE).rglob('*.py')):
        parts = path.relative_to(ROOT).with_suffix('').parts
        is_package = parts[-1] == '__init__'
        module = '.'.join(parts[:-1] if is_package else parts)
        sources.append(Source(module, path.read_text(encoding='utf-8'), is_package))
    return sources


def imports(source: Source) -> Iterator[Import]:
    """All imports of a source, wherever they stand: in functions and under conditions too."""
    for node in ast.walk(ast.parse(source.text)):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield Import(alias.name, node.lineno)
        elif isinstance(node, ast.ImportFrom):
            base = _base(source, node)
            for alias in node.names:
                yield Import(base if alias.name == '*' else f'{base}.{alias.name}', node.lineno)
        elif isinstance(node, ast.Call) and _called(node) in {'import_module', '__import__'}:
            name = node.args[0] if node.args else None
            if isinstance(name, ast.Constant) and isinstance(name.value, str):
                yield Import(name.value, node.lineno)


def _base(source: Source, node: ast.ImportFrom) -> str:
    """The absolute name of the module that a from-import imports from."""
    if node.level == 0:
        return node.module or ''
    parts = source.module.split('.')
    if not source.is_package:
        parts.pop()
    parts = parts[: len(parts) - node.level + 1]
    if not parts:
        raise ValueError(f'{source.module}, line {node.lineno}: import from above the package')
    return '.'.join([*parts, node.module] if node.module else parts)


def _called(node: ast.Call) -> str:
    function = node.func
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ''
