"""Files as plain values: JSON, and tables with separated values."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any, NoReturn

from blocks_planning.errors import StimulusError, shown

_SEPARATORS = ',;\t'


def parse_json(text: str, origin: str) -> Any:
    """The value of a JSON text.

    Raises:
        StimulusError: naming ``origin`` and line, if it is not JSON or has a key twice.
    """

    def pairs(items: list[tuple[str, Any]]) -> dict[str, Any]:
        entries: dict[str, Any] = {}
        for key, value in items:
            if key in entries:
                raise StimulusError(f'{origin}: key {shown(key)} appears twice')
            entries[key] = value
        return entries

    def refuse(constant: str) -> NoReturn:
        raise StimulusError(f'{origin}: {constant} is not JSON')

    try:
        return json.loads(text, object_pairs_hook=pairs, parse_constant=refuse)
    except json.JSONDecodeError as error:
        place = f'{origin}, line {error.lineno}, column {error.colno}'
        raise StimulusError(f'{place}: is not JSON: {error.msg}') from None
    except (RecursionError, ValueError) as error:
        if isinstance(error, StimulusError):
            raise
        raise StimulusError(f'{origin}: is nested too deeply, or has too long a number') from None


def parse_tables(text: str, origin: str) -> list[tuple[int, list[list[str]]]]:
    """The tables of a CSV text, separated by blank lines.

    The separator is the first of comma, semicolon and tab that the first line has; without any,
    every character of a line is a value.

    Returns:
        For each table the number of its first line, from 1, and its rows of values.

    Raises:
        StimulusError: naming ``origin`` and line, if a line can't be split, or all are blank.
    """
    lines = text.splitlines()
    first = next((line for line in lines if line.strip()), '')
    separator = next((sign for sign in _SEPARATORS if sign in first), None)
    tables: list[tuple[int, list[list[str]]]] = []
    open_table = False
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            open_table = False
            continue
        if not open_table:
            tables.append((number, []))
            open_table = True
        tables[-1][1].append(_values_of(line, separator, f'{origin}, line {number}'))
    if not tables:
        raise StimulusError(f'{origin}: is empty')
    return tables


def _values_of(line: str, separator: str | None, place: str) -> list[str]:
    if separator is None:
        return list(line.strip())
    try:
        [values] = csv.reader([line], delimiter=separator, strict=True)
    except csv.Error as error:
        raise StimulusError(f'{place}: is not a row of separated values: {error}') from None
    return [value.strip() for value in values]


def suffix_of(path: Path) -> str:
    """The ending of a file's name in lower case, such as '.json'."""
    return path.suffix.lower()
