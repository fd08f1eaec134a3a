"""Who may look, and who may say something."""

from __future__ import annotations

import socket

import pytest

from blocks_planning.errors import ConfigurationError
from blocks_planning.view.web.guards import (
    HEADERS,
    Address,
    RateLimit,
    address_of,
    is_loopback,
    is_same_origin,
)

TOKEN = 'a-token_of-24-characters'


@pytest.mark.parametrize('host', ['127.0.0.1', '127.8.8.8', 'localhost', '::1'])
def test_on_the_loopback_no_token_is_needed(host: str) -> None:
    assert is_loopback(host)
    assert address_of(host, 80) == Address(host, 80)


@pytest.mark.parametrize('host', ['0.0.0.0', '::', '192.0.2.7', 'lab.example'])
def test_off_the_loopback_there_is_a_token_always(host: str) -> None:
    one, other = address_of(host, 80), address_of(host, 80)
    assert len(one.token) >= 32
    assert one.token != other.token
    assert one.token in one.url
    assert address_of(host, 80, TOKEN).token == TOKEN
    with pytest.raises(ConfigurationError, match='set a token'):
        Address(host, 80)


@pytest.mark.parametrize('token', ['short', 'with a space in it, long', 'a;b' * 9, 'é' * 20])
def test_bad_token_is_refused_without_being_said(token: str) -> None:
    with pytest.raises(ConfigurationError, match='token must be 16 or more') as refused:
        address_of('127.0.0.1', 80, token)
    assert token not in str(refused.value)


@pytest.mark.parametrize(
    ('host', 'url'),
    [
        ('127.0.0.1', 'http://127.0.0.1:81/'),
        ('::1', 'http://[::1]:81/'),
        ('localhost', 'http://localhost:81/'),
    ],
)
def test_url_can_be_typed(host: str, url: str) -> None:
    assert Address(host, 81).url == url


def test_url_of_all_addresses_names_the_machine() -> None:
    assert address_of('0.0.0.0', 81).url.startswith(f'http://{socket.gethostname()}:81/?token=')


@pytest.mark.parametrize('header', ['127.0.0.1:81', 'localhost:81', 'LOCALHOST:81', '[::1]:81'])
def test_names_of_this_machine_are_its_host(header: str) -> None:
    assert Address(port=81).is_host(header)


@pytest.mark.parametrize(
    'header',
    [
        None,
        '',
        'evil.example:81',
        '127.0.0.1',
        '127.0.0.1:82',
        '127.0.0.1.evil.example:81',
        'localhost.evil.example:81',
        'user@127.0.0.1:81',
        '127.0.0.1:81/path',
        '127.0.0.1:99999',
        '[::1:81',
        '192.0.2.7:81',
    ],
)
def test_foreign_names_are_not(header: str | None) -> None:
    """A name that was made to point here is a foreign one."""
    assert not Address(port=81).is_host(header)


def test_off_the_loopback_numbers_and_its_name_are_its_host() -> None:
    address = address_of('lab.example', 81)
    for header in ('lab.example:81', '192.0.2.7:81', '[2001:db8::1]:81'):
        assert address.is_host(header)
    assert address.is_host(f'{socket.gethostname()}:81')
    assert not address.is_host('evil.example:81')


@pytest.mark.parametrize(
    ('origin', 'host', 'same'),
    [
        ('http://127.0.0.1:81', '127.0.0.1:81', True),
        ('https://Lab.example', 'lab.example', True),
        ('http://127.0.0.1:82', '127.0.0.1:81', False),
        ('http://evil.example', '127.0.0.1:81', False),
        ('http://127.0.0.1:81.evil.example', '127.0.0.1:81', False),
        ('null', '127.0.0.1:81', False),
        ('', '127.0.0.1:81', False),
        (None, '127.0.0.1:81', False),
        (None, None, False),
        ('', '', False),
    ],
)
def test_origin(origin: str | None, host: str | None, same: bool) -> None:
    assert is_same_origin(origin, host) is same


def test_cookie_admits() -> None:
    address = address_of('192.0.2.7', 81, TOKEN)
    assert address.is_admitted(f'other=1; {address.cookie}={TOKEN}')
    for cookies in (
        None,
        '',
        'other=1',
        f'{address.cookie}={TOKEN[:-1]}',
        f'x={TOKEN}',
        '=;=\x00',
    ):
        assert not address.is_admitted(cookies)
    assert Address().is_admitted(None)


def test_rate_is_limited_for_each_client() -> None:
    limit = RateLimit(burst=3, per_s=2.0)
    assert [limit.allows('a', 0.0) for _ in range(4)] == [True, True, True, False]
    assert limit.allows('b', 0.0)
    assert [limit.allows('a', 1.0) for _ in range(3)] == [True, True, False]
    assert [limit.allows('a', 100.0) for _ in range(4)] == [True, True, True, False]


def test_clients_that_are_counted_are_bounded() -> None:
    limit = RateLimit(burst=1, per_s=0.001)
    for number in range(3000):
        limit.allows(str(number), 0.0)
    assert len(limit._left) == 1000


def test_no_script_but_that_of_the_page_may_run() -> None:
    policy = dict(
        part.strip().split(' ', 1) for part in HEADERS['Content-Security-Policy'].split(';')
    )
    assert policy['default-src'] == "'none'"
    assert policy['script-src'] == policy['connect-src'] == "'self'"
    assert 'unsafe' not in HEADERS['Content-Security-Policy']
