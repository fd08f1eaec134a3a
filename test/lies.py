"""True records, and ways to lie in them."""

from __future__ import annotations

import json
from collections.abc import Callable
from copy import deepcopy
from typing import Any

from builders import CHAIR, EMPTY, FRAME, ODD, cancelled_record, record_json, remade, spec

from blocks_planning.errors import RecordError
from blocks_planning.trials.reading import record_from_json
from blocks_planning.trials.verify import contradictions

TRUE = {
    'scoping': record_json(CHAIR, lam=0.2, depth=2),
    'action': record_json(CHAIR, commit='action', lam=0.1, depth=1),
    'full': record_json(CHAIR, strategy='full', depth=1),
    'none': record_json(CHAIR, strategy='none', depth=2),
    'gave_up': record_json(FRAME, lam=0.05, depth=2),
    'stuck': record_json(ODD, lam=0.2, depth=2),
    'nothing': record_json(EMPTY),
    'cancelled': json.loads(cancelled_record(spec(CHAIR, lam=0.2, depth=2), 30).to_line()),
}


def found(data: dict[str, Any]) -> list[str]:
    """The contradictions of a record in which somebody lied, and then mended the sums."""
    try:
        return list(contradictions(record_from_json(remade(data), 'x')))
    except RecordError as error:
        return [str(error)]


Lie = Callable[[dict[str, Any]], object]


def put(*path: str | int, to: object) -> Lie:
    """A lie that puts something in the place of a part."""
    *above, last = path

    def lie(data: dict[str, Any]) -> None:
        part: Any = data
        for key in above:
            part = part[key]
        part[last] = to(part[last]) if callable(to) else to

    return lie


def both(*lies: Lie) -> Lie:
    """Several lies at once."""

    def lie(data: dict[str, Any]) -> None:
        for one in lies:
            one(data)

    return lie


def without(*path: str | int) -> Lie:
    """A lie that leaves out one of some parts."""
    *above, index = path

    def rest(parts: list[Any]) -> list[Any]:
        left = list(parts)
        del left[int(index)]
        return left

    return put(*above, to=rest)


def one_more(number: int) -> int:
    return number + 1


def one_less(number: int) -> int:
    return number - 1


def twice(index: int) -> Callable[[list[Any]], list[Any]]:
    return lambda parts: [*parts[: index + 1], deepcopy(parts[index]), *parts[index + 1 :]]


def turned(parts: list[Any]) -> list[Any]:
    return parts[::-1]


def and_landed(*block: int) -> Callable[[list[Any]], list[Any]]:
    more = {'ordered': [*block[:3]], 'landed': [[*block]], 'gone': []}
    return lambda seen: [*seen, more]


def first_block(_: object) -> list[Any]:
    """The block that stands first in the record of a scoping trial."""
    return [TRUE['scoping']['placements'][0]]


def in_decision(index: int, key: str, to: object) -> Lie:
    return put('decisions', index, key, to=to)
