"""Every setting of every family, as names in one flat list.

Command-line options and columns of tables are flat: they cannot express "the lambda of the
strategy". The flat name of a setting is its own name. If another family or another column of the
table of trials has that name, the name of the family is put before it, such as ``world_blocks``.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from blocks_planning.settings import Setting, Value, all_settings, settings_of
from blocks_planning.trials.record import SUMMARY_KEYS
from blocks_planning.trials.spec import FAMILIES, TrialSpec

RESERVED = frozenset(
    [
        *FAMILIES,
        *('trial_id', 'experiment', 'stimulus', 'seed', 'seeds', 'budget', 'status', 'error'),
        *('library', 'reason'),
        *SUMMARY_KEYS,
    ]
)
"""Names of other columns and options."""


@dataclass
class FlatSetting:
    """A setting under its flat name.

    Attributes:
        name: unique among all settings of all families.
        family: to which it belongs.
        key: its name within the family.
        members: descriptions of the setting, by the name of the member that has it.
    """

    name: str
    family: str
    key: str
    members: dict[str, Setting] = field(default_factory=dict)

    @property
    def text(self) -> str:
        """What the setting is; if members describe it differently, each in its own words."""
        users = self._users('text')
        if len(users) == 1:
            return next(iter(users))
        return ' '.join(f'For {names}: {_uncapitalised(text)}' for text, names in users.items())

    @property
    def kind(self) -> type:
        """The type of its values: float where members differ between int and float."""
        kinds = {one.kind for one in self.members.values()}
        if len(kinds) == 1:
            return kinds.pop()
        return float if kinds == {int, float} else str

    @property
    def choices(self) -> tuple[str, ...]:
        """The words that at least one member allows; empty if a member allows any word."""
        words: dict[str, None] = {}
        for one in self.members.values():
            allowed = one.choices or (tuple(one.family) if one.family is not None else ())
            if not allowed:
                return ()
            words.update(dict.fromkeys(allowed))
        return tuple(words)

    @property
    def defaults(self) -> str:
        """The defaults with their members, such as '0.002 for scoping, 1.0 for full'."""
        return ', '.join(f'{value} for {names}' for value, names in self._users('default').items())

    def _users(self, attribute: str) -> dict[str, str]:
        """The members, such as 'astar/best_first', by what an attribute of theirs says."""
        users: dict[str, list[str]] = {}
        for name, one in self.members.items():
            users.setdefault(str(getattr(one, attribute)), []).append(name)
        return {said: '/'.join(names) for said, names in users.items()}


def _uncapitalised(text: str) -> str:
    return text[:1].lower() + text[1:]


def flat_settings(wanted: Callable[[type[Any]], bool] | None = None) -> list[FlatSetting]:
    """All settings of all members of all families, or of the members that are ``wanted``."""
    found: dict[tuple[str, str], FlatSetting] = {}
    for family, member, one in _settings(wanted):
        place = (family, one.name)
        found.setdefault(place, FlatSetting(one.name, family, one.name)).members[member] = one
    families_with = Counter(key for _, key in found)
    for flat in found.values():
        if families_with[flat.key] > 1 or flat.key in RESERVED:
            flat.name = f'{flat.family}_{flat.key}'
    return list(found.values())


def _settings(wanted: Callable[[type[Any]], bool] | None) -> Iterator[tuple[str, str, Setting]]:
    for family, registry in FAMILIES.items():
        for name, cls in registry.items():
            if wanted is None or wanted(cls):
                for one in all_settings(cls):
                    yield family, name, one


def flat_values(spec: TrialSpec, settings: list[FlatSetting]) -> dict[str, Value | None]:
    """The value of each setting in a trial; None if its members do not have it."""
    values = {family: settings_of(getattr(spec, family)) for family in FAMILIES}
    return {flat.name: values[flat.family].get(flat.key) for flat in settings}


def members_from(
    names: Mapping[str, str], values: Mapping[str, Any], settings: list[FlatSetting]
) -> dict[str, Any]:
    """The member of each family from its name and flat values; None stands for 'not given'.

    Raises:
        ConfigurationError: for an unknown name, a setting that the member does not have, or a
            value that is not allowed.
    """
    given: dict[str, dict[str, Any]] = {family: {} for family in FAMILIES}
    for flat in settings:
        if values.get(flat.name) is not None:
            given[flat.family][flat.key] = values[flat.name]
    return {
        family: registry.make(names[family], given[family])
        for family, registry in FAMILIES.items()
    }
