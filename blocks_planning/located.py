"""YAML in which every value knows its line, so that errors can name the place."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import yaml

from blocks_planning.errors import ConfigurationError, InvalidInput, shown

T = TypeVar('T')
MAX_FILE_BYTES = 1 << 20
MAX_VALUES = 100_000
"""Nested aliases in a few lines could expand to more values than fit into memory."""


@dataclass(frozen=True)
class Located:
    """A value of a YAML file, with its place in the file.

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
            ConfigurationError: if it is not a mapping, a key is missing, or a key is unknown.
        """
        entries = self.mapping()
        for key in entries:
            if key not in (*required, *optional):
                raise entries[key].fail(
                    f'unknown key; expected one of {", ".join((*required, *optional))}'
                )
        for key in required:
            if key not in entries:
                raise self.fail(f'missing key {key!r}')
        return entries

    def mapping(self) -> dict[str, Located]:
        """The entries of a mapping with any keys."""
        if not isinstance(self.content, dict):
            raise self.fail(f'expected keys with values, got {self}')
        return self.content

    def items(self) -> list[Located]:
        """The items of a list that is not empty."""
        if not isinstance(self.content, list) or not self.content:
            raise self.fail(f'expected a list with at least one item, got {self}')
        return self.content

    def __str__(self) -> str:
        """The value as an error message shows it: on one line, and cut if it is long."""
        if isinstance(self.content, dict):
            return f'{len(self.content)} keys with values'
        if isinstance(self.content, list):
            return f'a list of {len(self.content)} items'
        return shown(self.content)

    def plain(self) -> Any:
        """The value without places."""
        if isinstance(self.content, dict):
            return {key: value.plain() for key, value in self.content.items()}
        if isinstance(self.content, list):
            return [item.plain() for item in self.content]
        return self.content

    def check(self, function: Callable[[], T]) -> T:
        """Call a function; put the place before the message of an error that it raises."""
        try:
            return function()
        except InvalidInput as error:
            raise self.fail(str(error)) from None


def read_yaml(path: Path) -> Located:
    """Read a YAML file.

    Raises:
        ConfigurationError: if it can't be read, is not YAML, repeats a key, is larger than
            ``MAX_FILE_BYTES`` or expands to more than ``MAX_VALUES`` values; the message names
            file and line.
    """
    try:
        with path.open('rb') as file:
            data = file.read(MAX_FILE_BYTES + 1)
        if len(data) > MAX_FILE_BYTES:
            raise ConfigurationError(f'{path}: is larger than {MAX_FILE_BYTES} bytes')
        node = yaml.compose(data.decode(), Loader=yaml.SafeLoader)
        if node is None:
            raise ConfigurationError(f'{path}: is empty')
        return _Reader(str(path)).locate(node, '')
    except OSError as error:
        raise ConfigurationError(f'{path}: cannot be read: {error.strerror}') from None
    except UnicodeDecodeError as error:
        raise ConfigurationError(f'{path}: is not a text file (byte {error.start})') from None
    except yaml.YAMLError as error:
        mark = getattr(error, 'problem_mark', None)
        place = f'{path}, line {mark.line + 1}' if mark else str(path)
        problem = getattr(error, 'problem', None) or 'unreadable'
        raise ConfigurationError(f'{place}: is not YAML: {" ".join(problem.split())}') from None
    except RecursionError:
        raise ConfigurationError(f'{path}: is nested too deeply') from None


class _Reader:
    """Gives the values of a file their places, and counts them."""

    def __init__(self, path: str) -> None:
        self._path = path
        self._left = MAX_VALUES

    def locate(self, node: yaml.Node, key: str) -> Located:
        """The value of a node; ``key`` is '' if it does not belong to a key."""
        place = self._place(node, key)
        self._left -= 1
        if self._left < 0:
            raise ConfigurationError(f'{place}: the file has more than {MAX_VALUES} values')
        if isinstance(node, yaml.MappingNode):
            return Located(dict(self._entries(node)), place)
        if isinstance(node, yaml.SequenceNode):
            return Located([self.locate(item, key) for item in node.value], place)
        try:
            return Located(yaml.SafeLoader('').construct_object(node), place)
        except RecursionError:
            raise
        except Exception:  # noqa: BLE001  such as !!bool maybe, for which PyYAML raises other errors
            raise ConfigurationError(
                f'{place}: {shown(node.value)} is not a value that can be read'
            ) from None

    def _place(self, node: yaml.Node, key: str) -> str:
        line = f'{self._path}, line {node.start_mark.line + 1}'
        return f'{line}, key {shown(key)}' if key else line

    def _entries(self, node: yaml.MappingNode) -> Iterator[tuple[str, Located]]:
        seen = set()
        for name, value in node.value:
            if not isinstance(name, yaml.ScalarNode):
                raise ConfigurationError(f'{self._place(name, "")}: a key must be a word')
            key = str(name.value)
            if key in seen:
                raise ConfigurationError(f'{self._place(name, key)}: appears twice')
            seen.add(key)
            located = self.locate(value, key)
            yield key, Located(located.content, self._place(name, key))
