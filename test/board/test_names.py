"""Names of towers: letters of any script; what is refused says what a name may contain."""

from __future__ import annotations

import unicodedata
from pathlib import Path

import pytest
from builders import picture
from hypothesis import given
from hypothesis import strategies as st

from blocks_planning.board.names import MAX_NAME, name_fault, suggested
from blocks_planning.board.pictures import format_silhouette, parse_silhouettes
from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.errors import StimulusError

STEP = '#.\n##\n'


@pytest.mark.parametrize(
    'name',
    [
        'a',
        '9',
        'A_b.c-9',
        'é',
        'Türme',
        'ворота',
        '門',
        'หอคอย',
        'मीनार',
        'برج',
        '٣',
        'x' * MAX_NAME,
    ],
)
def test_letters_and_digits_of_any_script_make_a_name(name: str) -> None:
    assert list(parse_silhouettes(f'tower {name}\n{STEP}', 'x')) == [name]


def test_two_ways_to_type_an_accent_are_one_name() -> None:
    apart, composed = (unicodedata.normalize(form, 'tür') for form in ('NFD', 'NFC'))
    assert apart != composed
    assert list(parse_silhouettes(f'tower {apart}\n{STEP}', 'x')) == [composed]
    with pytest.raises(StimulusError, match='already a tower'):
        parse_silhouettes(f'tower {apart}\n{STEP}\ntower {composed}\n{STEP}', 'x')


def test_an_address_finds_a_name_typed_either_way(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = f'tower {unicodedata.normalize("NFD", "tür")}\n{STEP}'
    Path('towers.txt').write_text(text, encoding='utf-8')
    for form in ('NFD', 'NFC'):
        [found] = find_stimuli(f'towers.txt/{unicodedata.normalize(form, "tür")}')
        assert (found.board, found.silhouette) == picture('#./##')


@pytest.mark.parametrize(
    ('heading', 'column', 'words'),
    [
        ('tower my gate', 9, "got 'my gate'; try 'my-gate'"),
        ('tower a/b', 8, "got 'a/b'; try 'a-b'"),
        ('tower a\u200bb', 8, r"got 'a\u200bb'; try 'a-b'"),
        ('tower \u2603', 7, "got '\u2603'"),
        ('tower', 6, 'got none'),
        ('tower  # no name', 6, 'got none'),
        (f'tower {"x" * (MAX_NAME + 1)}', 7 + MAX_NAME, f'{MAX_NAME} characters at most'),
    ],
)
def test_what_is_no_name_is_told_what_is(heading: str, column: int, words: str) -> None:
    with pytest.raises(StimulusError) as caught:
        parse_silhouettes(f'\n{heading}\n{STEP}', 'towers.txt')
    message = str(caught.value)
    assert message.startswith(f'towers.txt, line 2, column {column}: ')
    assert 'letters (of any script), digits' in message
    assert words in message


@given(st.text(max_size=150))
def test_what_is_suggested_is_a_name(text: str) -> None:
    name = suggested(text)
    assert not name or name_fault(name) is None
    if name:
        assert list(parse_silhouettes(format_silhouette(name, *picture('#')), 'x')) == [name]
