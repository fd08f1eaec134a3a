"""Settings as data: each setting is described once, and everything else is derived from that.

A *family* is a group of classes of which a trial names one: searches, strategies, region families,
worlds. Each class is a frozen dataclass derived from :class:`Configured`; its fields are its
settings, declared with :func:`setting`. The command line, scripts and sweeps, trial ids, records,
messages, tables, help and the table in the documentation all read these descriptions::

    @dataclass(frozen=True)
    class Beam(Configured):
        '''Keep the best states of each level.'''

        name: ClassVar[str] = 'beam'
        width: int = setting(8, 'States kept per level.', least=1, most=4096, unit='states')

A setting may itself be a member of a family (:func:`member`), such as the region family of a
strategy. The settings of that member stand beside those of its owner, in one flat namespace.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator, Mapping, ValuesView
from dataclasses import Field, dataclass, field, fields
from typing import Any, ClassVar, Protocol, TypeAlias

from blocks_planning.errors import ConfigurationError, shown

Value: TypeAlias = bool | int | float | str
"""Types of values outside Python: those of JSON and of ROS messages."""


class Family(Protocol):
    """The members of a family by name; see :class:`blocks_planning.families.Registry`."""

    kind: str

    def __getitem__(self, name: str) -> type[Any]: ...

    def __iter__(self) -> Iterator[str]: ...

    def values(self) -> ValuesView[type[Any]]:
        """Every member."""
        ...

    def find(self, name: object) -> type[Any]:
        """The member of a name; raises ConfigurationError for an unknown one."""
        ...


@dataclass(frozen=True)
class Setting:
    """The description of a setting.

    Attributes:
        kind: ``bool``, ``int``, ``float`` or ``str``.
        text: one line of help.
        name: its name outside Python; '' until the field is known.
        default: value if none is given.
        unit: of the value; '' if it has none.
        least: smallest value allowed; None: no bound.
        most: largest value allowed; None: no bound.
        above: every value is above this number; None: no such bound.
        choices: the words allowed; empty: any.
        pattern: regular expression that a word must match; '': any.
        expected: the pattern in words.
        family: registry of the family whose member this setting is; None for a plain value.
    """

    kind: type
    text: str
    name: str = ''
    default: Any = None
    unit: str = ''
    least: float | None = None
    most: float | None = None
    above: float | None = None
    choices: tuple[str, ...] = ()
    pattern: str = ''
    expected: str = ''
    family: Family | None = None

    @property
    def requirement(self) -> str:
        """What a value must be, in words that follow 'must be'."""
        if self.kind is bool:
            return 'true or false'
        if self.kind is str:
            words = self.choices or (tuple(self.family) if self.family is not None else ())
            return f'one of {", ".join(words)}' if words else self.expected or 'a text'
        if self.kind is int:
            return f'a whole number{self._bounds}'
        return f'a finite number{self._bounds}'

    @property
    def _bounds(self) -> str:
        if self.least is not None and self.most is not None:
            return f' from {self.least:g} to {_plain(self.most)}'
        if self.least is not None:
            return f' of {self.least:g} or more'
        if self.above is not None:
            upper = '' if self.most is None else f' and at most {_plain(self.most)}'
            return f' above {self.above:g}{upper}'
        return '' if self.most is None else f' of at most {_plain(self.most)}'

    def check(self, value: object) -> Any:
        """Return a value in the setting's own type.

        Raises:
            ConfigurationError: naming the setting and the value, if it cannot be used.
        """
        if not self._allows(value):
            raise ConfigurationError(f'{self.name} must be {self.requirement}, got {shown(value)}')
        return self.kind(value)

    def _allows(self, value: object) -> bool:
        if self.kind is bool:
            return isinstance(value, bool)
        if self.kind is str:
            return isinstance(value, str) and self._allows_word(value)
        numbers = int if self.kind is int else (int, float)
        if isinstance(value, bool) or not isinstance(value, numbers):
            return False
        if self.kind is float and not abs(value) <= sys.float_info.max:
            return False
        return (
            (self.least is None or value >= self.least)
            and (self.most is None or value <= self.most)
            and (self.above is None or value > self.above)
        )

    def _allows_word(self, word: str) -> bool:
        if self.choices:
            return word in self.choices
        return not self.pattern or re.fullmatch(self.pattern, word) is not None


def _plain(number: float) -> str:
    return str(number) if isinstance(number, int) else f'{number:g}'


def setting(
    default: Value,
    text: str,
    *,
    name: str = '',
    unit: str = '',
    least: float | None = None,
    most: float | None = None,
    above: float | None = None,
    choices: tuple[str, ...] = (),
    pattern: str = '',
    expected: str = '',
) -> Any:
    """A dataclass field that is a setting; see :class:`Setting` for the arguments.

    Args:
        default: its type is the setting's type.
        text: one line of help.
        name: name outside Python, if it differs from the name of the field.
        unit: of the value.
        least: smallest value.
        most: largest value.
        above: bound that every value must exceed.
        choices: the words allowed.
        pattern: that a word must match.
        expected: the pattern in words.
    """
    described = Setting(
        kind=type(default),
        text=text,
        name=name,
        default=default,
        unit=unit,
        least=least,
        most=most,
        above=above,
        choices=choices,
        pattern=pattern,
        expected=expected,
    )
    return field(default=default, metadata={'setting': described})


def member(default: str, family: Family, text: str) -> Any:
    """A dataclass field that is a member of a family, by default the one named ``default``."""
    described = Setting(kind=str, text=text, default=default, family=family)
    return field(default_factory=_default_of(family, default), metadata={'setting': described})


def _default_of(family: Family, name: str) -> Callable[[], Any]:
    """A factory that looks the member up only when it is needed."""

    def make() -> Any:
        return family[name]()

    return make


_DESCRIBED: dict[Any, tuple[tuple[str, Setting], ...]] = {}


def described(cls: type[Any]) -> tuple[tuple[str, Setting], ...]:
    """The settings that a class declares itself, each with the name of its field."""
    if cls not in _DESCRIBED:
        _DESCRIBED[cls] = tuple((entry.name, _described(entry)) for entry in fields(cls))
    return _DESCRIBED[cls]


def _described(entry: Field[Any]) -> Setting:
    found: Setting = entry.metadata['setting']
    return Setting(**{**vars(found), 'name': found.name or entry.name})


class Configured:
    """Base of every member of a family: checks each setting when an instance is made.

    Raises:
        ConfigurationError: for a value that its setting does not allow.
    """

    name: ClassVar[str]
    is_external: ClassVar[bool] = False  # whether it stands for another program
    plans_on_blocks: ClassVar[bool] = False  # whether a search must know the blocks of a state

    def __post_init__(self) -> None:
        for attribute, known in described(type(self)):
            if known.family is None:
                value = known.check(getattr(self, attribute))
                object.__setattr__(self, attribute, value)


def settings_of(thing: Any) -> dict[str, Value]:
    """The settings of a member by name, those of its own members among them."""
    found: dict[str, Value] = {}
    for attribute, known in described(type(thing)):
        value = getattr(thing, attribute)
        if known.family is None:
            found[known.name] = value
        else:
            found[known.name] = value.name
            found |= settings_of(value)
    return found


def settings_for(cls: type[Any], values: Mapping[str, object]) -> Iterator[Setting]:
    """The settings that a class has, given the values that select its members."""
    for _, known in described(cls):
        yield known
        if known.family is not None:
            yield from settings_for(known.family.find(values.get(known.name, known.default)), {})


def all_settings(cls: type[Any]) -> Iterator[Setting]:
    """Every setting that a class can have, with those of every member that it can hold."""
    for _, known in described(cls):
        yield known
        if known.family is not None:
            for one in known.family.values():
                yield from all_settings(one)


def setting_names(cls: type[Any]) -> list[str]:
    """The names of every setting that a class can have."""
    return [one.name for one in all_settings(cls)]


def build(kind: str, cls: type[Any], values: Mapping[str, object]) -> Any:
    """An instance of a class from flat settings; those not given keep their defaults.

    Raises:
        ConfigurationError: for an unknown setting, or a value that its setting does not allow.
    """
    known = [one.name for one in settings_for(cls, values)]
    for name in values:
        if name not in known:
            raise ConfigurationError(
                f'{kind} {cls.name} has no setting {shown(name)}; '
                f'it has {", ".join(known) or "none"}'
            )
    arguments = {}
    for attribute, one in described(cls):
        if one.family is not None:
            chosen = one.family.find(values.get(one.name, one.default))
            own = {s.name for s in settings_for(chosen, values)}
            arguments[attribute] = build(
                one.family.kind, chosen, {n: v for n, v in values.items() if n in own}
            )
        elif one.name in values:
            arguments[attribute] = values[one.name]
    return cls(**arguments)


def check_whole(name: str, value: object, least: int, most: int) -> None:
    """Refuse what is not a whole number from ``least`` to ``most``.

    Raises:
        ConfigurationError: naming ``name`` and the value.
    """
    Setting(int, '', name, least=least, most=most).check(value)
