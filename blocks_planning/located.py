"""YAML whose every value knows its line, so that an error can say where it is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import yaml

from blocks_planning.errors import ConfigurationError, InvalidInput

T = TypeVar('T')


@dataclass(frozen=True)
class Located:
    """A value of a YAML file, with the place where it stands.

    ``content`` is a plain value, a list of :class:`Located`, or a dict of them by key.
    """

    content: Any
    place: str

    def fail(self, reason: str) -> ConfigurationError:
        """The error that names the place."""
        return ConfigurationError(f'{self.place}: {reason}')

    def entries(self, *required: str, optional: tuple[str, ...] = ()) -> dict[str, Located]:
        """The entries of a mapping with just these keys.

        Raises:
            ConfigurationError: if it is no mapping, lacks a key or has another one.
        """
        entries = self.mapping()
        for key in entries:
            if key not in (*required, *optional):
                raise entries[key].fail(
                    f'is not a key here; there are {", ".join((*required, *optional))}'
                )
        for key in required:
            if key not in entries:
                raise self.fail(f'lacks the key {key!r}')
        return entries

    def mapping(self) -> dict[str, Located]:
        """The entries of a mapping with any keys."""
        if not isinstance(self.content, dict):
            raise self.fail(f'expected keys with values, got {self.plain()!r}')
        return self.content

    def items(self) -> list[Located]:
        """The items of a list that is not empty."""
        if not isinstance(self.content, list) or not self.content:
            raise self.fail(f'expected a list with at least one item, got {self.plain()!r}')
        return self.content

    def plain(self) -> Any:
        """The value without places."""
        if isinstance(self.content, dict):
            return {key: value.plain() for key, value in self.content.items()}
        if isinstance(self.content, list):
            return [item.plain() for item in self.content]
        return self.content

    def check(self, function: Callable[[], T]) -> T:
        """Call a function, and put the place before what it complains about."""
        try:
            return function()
        except InvalidInput as error:
            raise self.fail(str(error)) from None


def read_yaml(path: Path) -> Located:
    """Read a YAML file.

    Raises:
        ConfigurationError: if it can't be read, is not YAML, or repeats a key; it names file and
            line.
    """
    try:
        node = yaml.compose(path.read_text(encoding='utf-8'), Loader=yaml.SafeLoader)
        if node is None:
            raise ConfigurationError(f'{path}: is empty')
        return _locate(node, str(path), '')
    except OSError as error:
        raise ConfigurationError(f'{path}: cannot be read: {error.strerror}') from None
    except UnicodeDecodeError as error:
        raise ConfigurationError(f'{path}: is not a text file (byte {error.start})') from None
    except yaml.YAMLError as error:
        mark = getattr(error, 'problem_mark', None)
        place = f'{path}, line {mark.line + 1}' if mark else str(path)
        problem = getattr(error, 'problem', None) or 'unreadable'
        raise ConfigurationError(f'{place}: is not YAML: {problem}') from None
    except RecursionError:
        raise ConfigurationError(f'{path}: is nested too deeply') from None


def _locate(node: yaml.Node, path: str, key: str) -> Located:
    place = f'{path}, line {node.start_mark.line + 1}' + (f', key {key!r}' if key else '')
    if isinstance(node, yaml.MappingNode):
        return Located(dict(_entries(node, path)), place)
    if isinstance(node, yaml.SequenceNode):
        return Located([_locate(item, path, key) for item in node.value], place)
    try:
        return Located(yaml.SafeLoader('').construct_object(node), place)
    except (yaml.YAMLError, ValueError):
        shown = str(node.value)[:40]
        raise ConfigurationError(f'{place}: {shown!r} is no value that can be read') from None


def _entries(node: yaml.MappingNode, path: str) -> Iterator[tuple[str, Located]]:
    seen = set()
    for name, value in node.value:
        key = str(name.value)
        line = name.start_mark.line + 1
        if key in seen:
            raise ConfigurationError(f'{path}, line {line}, key {key!r}: is there twice')
        seen.add(key)
        located = _locate(value, path, key)
        yield key, Located(located.content, f'{path}, line {line}, key {key!r}')
