"""An immutable mapping of answered queries to which answers can be added cheaply.

A part never changes its memory; it makes a new one. Copying thousands of answers for each new one
would take quadratic time, so all memories share one store, and each sees only the answers that
had been added when it was made.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from blocks_planning.search.result import SolveResult
from blocks_planning.subgoals.decision import Query


class Answers(Mapping[Query, SolveResult]):
    """Results by query, in the order in which they were added."""

    def __init__(self) -> None:
        """Make an empty mapping."""
        self._store: dict[Query, tuple[int, SolveResult]] = {}
        self._size = 0

    def with_answer(self, query: Query, result: SolveResult) -> Answers:
        """These answers and a new one; copies only if another one was added to these before."""
        added = Answers()
        if len(self._store) == self._size:
            added._store = self._store
        else:
            added._store = dict(list(self._store.items())[: self._size])
        added._store[query] = self._size, result
        added._size = self._size + 1
        return added

    def latest(self, most: int) -> Answers:
        """These answers without the oldest, if there are more than ``most``."""
        if self._size <= most:
            return self
        kept = Answers()
        for query in list(self)[self._size - most :]:
            kept = kept.with_answer(query, self[query])
        return kept

    def __getitem__(self, query: Query) -> SolveResult:
        number, result = self._store[query]
        if number >= self._size:
            raise KeyError(query)
        return result

    def __iter__(self) -> Iterator[Query]:
        yield from list(self._store)[: self._size]

    def __len__(self) -> int:
        return self._size
