"""Settings from outside: checking values, and making a thing by name from a registry.

A registry maps names to frozen dataclasses whose fields are settings. A field whose outside name
is no Python name says so in its metadata, ``field(metadata={'setting': 'lambda'})``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import Field, fields
from typing import Any

from blocks_planning.errors import ConfigurationError, shown


def check_whole(name: str, value: object, least: int, most: int) -> None:
    """Refuse what is not a whole number from ``least`` to ``most``.

    Raises:
        ConfigurationError: naming ``name`` and the value.
    """
    if not isinstance(value, int) or isinstance(value, bool) or not least <= value <= most:
        raise ConfigurationError(
            f'{name} must be a whole number from {least} to {most}, got {shown(value)}'
        )


def check_word(name: str, value: object, words: tuple[str, ...]) -> None:
    """Refuse what is not one of some words.

    Raises:
        ConfigurationError: naming ``name`` and the value.
    """
    if not isinstance(value, str) or value not in words:
        raise ConfigurationError(f'{name} must be one of {", ".join(words)}, got {shown(value)}')


def setting_name(field: Field[Any]) -> str:
    """The name that a field has outside."""
    return str(field.metadata.get('setting', field.name))


def setting_names(kind: type[Any]) -> list[str]:
    """The settings that a registered kind of thing has, by their outside names."""
    return [setting_name(field) for field in fields(kind)]


def settings_of(thing: Any) -> dict[str, Any]:
    """The settings of a registered thing, by their outside names."""
    return {setting_name(field): getattr(thing, field.name) for field in fields(thing)}


def make(
    kind: str, registry: Mapping[str, type[Any]], name: object, settings: Mapping[str, Any]
) -> Any:
    """The thing of a name, with the settings given; the rest keep their defaults.

    Raises:
        ConfigurationError: for an unknown name or setting, or a value out of its range.
    """
    if not isinstance(name, str) or name not in registry:
        raise ConfigurationError(f'{kind} must be one of {", ".join(registry)}, got {shown(name)}')
    known = {setting_name(field): field.name for field in fields(registry[name])}
    for setting in settings:
        if setting not in known:
            raise ConfigurationError(
                f'{kind} {name} has no setting {shown(setting)}; it has {", ".join(known) or "none"}'
            )
    return registry[name](**{known[setting]: value for setting, value in settings.items()})
