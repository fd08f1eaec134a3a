"""Trials as they are heard, servers, and the page in a browser."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from builders import CHAIR, spec
from heard_trials import Heard, heard, human_spec, person_says
from page_fixture import browser, opened, stage, troubles  # noqa: F401
from served import TOKEN, Served

from blocks_planning.view.web.guards import Address, address_of


@pytest.fixture(scope='session')
def scoped() -> Heard:
    """A trial without a person."""
    return heard(spec(CHAIR, lam=0.2, depth=2))


@pytest.fixture(scope='session')
def by_person() -> Heard:
    """A trial in which a person scopes."""
    trial = human_spec()
    return heard(trial, person_says(trial))


@pytest.fixture(scope='session')
def hidden() -> Heard:
    """The same with its costs hidden."""
    trial = human_spec(costs='hidden')
    return heard(trial, person_says(trial))


@pytest.fixture
def served() -> Iterator[Served]:
    """A server on the loopback."""
    made = Served(Address())
    yield made
    made.server.stop()


@pytest.fixture
def with_token() -> Iterator[Served]:
    """A server that asks for a token."""
    made = Served(address_of('0.0.0.0', 0, TOKEN))
    yield made
    made.server.stop()
