"""A family's members by name: those of this package and those of installed plug-ins.

A plug-in is a class that another distribution names in an entry point of the family's group::

    [project.entry-points.'blocks_planning.searches']
    greedy = 'my_package.greedy:Greedy'

Entry points are read when a requested name is not in this package, or when all names
are listed. A plug-in that cannot be loaded is named in errors and has no other effect.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from importlib.metadata import EntryPoint, entry_points
from typing import Any

from blocks_planning import settings
from blocks_planning.errors import ConfigurationError, shown


class Registry(Mapping[str, type[Any]]):
    """The members of a family by name, in the order in which they are listed.

    Attributes:
        kind: what a member is called in errors and help, such as 'search'.
        group: of the entry points.
        broken: names of plug-ins that could not be loaded, with the reason.
    """

    def __init__(self, kind: str, group: str, members: Iterable[type[Any]] = ()) -> None:
        """Make a family of the members of this package."""
        self.kind = kind
        self.group = group
        self.broken: dict[str, str] = {}
        self._members: dict[str, type[Any]] = {}
        self._is_loaded = False
        for cls in members:
            self.add(cls)

    def add(self, cls: type[Any]) -> type[Any]:
        """Add a member; usable as a decorator.

        Raises:
            ConfigurationError: if its name is taken or empty.
        """
        name = getattr(cls, 'name', '')
        if not isinstance(name, str) or not name.isidentifier():
            raise ConfigurationError(
                f'{cls.__qualname__}.name must be letters, digits and _, got {shown(name)}'
            )
        if name in self._members:
            raise ConfigurationError(f'{self.kind} {name!r} exists already')
        self._members[name] = cls
        return cls

    @contextmanager
    def added(self, cls: type[Any]) -> Iterator[type[Any]]:
        """Add a member for the duration of a ``with`` block."""
        self.add(cls)
        try:
            yield cls
        finally:
            del self._members[cls.name]

    def __getitem__(self, name: str) -> type[Any]:
        if name not in self._members:
            self._load()
        return self._members[name]

    def __iter__(self) -> Iterator[str]:
        self._load()
        return iter(tuple(self._members))

    def __len__(self) -> int:
        self._load()
        return len(self._members)

    def find(self, name: object) -> type[Any]:
        """The member of a name.

        Raises:
            ConfigurationError: for an unknown name; it lists those that exist.
        """
        if isinstance(name, str):
            try:
                return self[name]
            except KeyError:
                pass
        raise ConfigurationError(
            f'{self.kind} must be one of {", ".join(self)}, got {shown(name)}{self._reason(name)}'
        )

    def make(self, name: object, values: Mapping[str, object]) -> Any:
        """The member of a name with some settings; the others keep their defaults.

        Raises:
            ConfigurationError: for an unknown name or setting, or a value that is not allowed.
        """
        return settings.build(self.kind, self.find(name), values)

    def _reason(self, name: object) -> str:
        reason = self.broken.get(name) if isinstance(name, str) else None
        return '' if reason is None else f' (its plug-in cannot be loaded: {reason})'

    def _load(self) -> None:
        if self._is_loaded:
            return
        self._is_loaded = True
        for entry in entry_points(group=self.group):
            reason = self._plug_in(entry)
            if reason:
                self.broken[entry.name] = reason

    def _plug_in(self, entry: EntryPoint) -> str:
        """Add the class of an entry point; return why it cannot be used, or ''."""
        try:
            cls = entry.load()
            if cls.name != entry.name:
                return f'its class is named {cls.name!r}'
            self.add(cls)
        except Exception as error:  # noqa: BLE001  a plug-in may raise anything
            return f'{type(error).__name__}: {error}'
        return ''
