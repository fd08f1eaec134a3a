"""Names of towers: one word of letters of any script, digits, '_', '.' and '-'.

A name is part of an address on the command line (``my/towers.txt/gate``), so it has neither blanks
nor a '/'. Names are compared in Unicode's composed form (NFC): two ways of typing the same accent
give the same name.
"""

from __future__ import annotations

import unicodedata

from blocks_planning.errors import shown

MAX_NAME = 100
"""Longest name [characters]."""
_SIGNS = '_.-'
_RULE = "a tower's name is one word of letters (of any script), digits, '_', '.' and '-'"


def normalised(name: str) -> str:
    """A name in the form in which names are compared."""
    return unicodedata.normalize('NFC', name)


def name_fault(name: str) -> tuple[int, str] | None:
    """Why a text is not a valid name.

    Returns:
        (index of the first character that is wrong, the reason in one line), or None if the text
        is a name.
    """
    if not name:
        return 0, f'{_RULE}, got none'
    for index, character in enumerate(name):
        if not _may_stand(character):
            instead = suggested(name)
            hint = f'; try {shown(instead)}' if instead else ''
            return index, f'{_RULE}, got {shown(name)}{hint}'
    if len(name) > MAX_NAME:
        return MAX_NAME, f'{_RULE}, {MAX_NAME} characters at most, got {len(name)}'
    return None


def suggested(text: str) -> str:
    """The name nearest to a text: '-' replaces invalid characters; '' if there is none."""
    kept = ''.join(sign if _may_stand(sign) else ' ' for sign in normalised(text))
    return '-'.join(kept.split())[:MAX_NAME]


def _may_stand(character: str) -> bool:
    """Whether a character is a letter, a mark on one, a digit, or one of the signs."""
    return character in _SIGNS or unicodedata.category(character)[0] in 'LMN'
