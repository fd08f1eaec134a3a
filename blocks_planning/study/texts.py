"""Texts of a study: a small part of Markdown, read into data.

A page makes its elements from this data and inserts every word as text, so that nothing in a text
can become markup or a script. There are paragraphs, headings (``#`` to ``###``), lists (``-``,
``*`` or ``1.``), ``**strong**`` and ``*emphasised*`` words; everything else is shown as it stands.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

_HEADING = re.compile(r'#{1,3}\s+(.*?)\s*#*')
_ITEM = re.compile(r'\s*(?:[-*]|(\d{1,3})[.)])\s+(.*)')
_SPAN = re.compile(r'\*\*(?=\S)(.+?)(?<=\S)\*\*|\*(?=[^\s*])(.+?)(?<=[^\s*])\*')


class Span(NamedTuple):
    """Some words, and the element they stand in: 'strong', 'em', or '' for none."""

    tag: str
    text: str


class Block(NamedTuple):
    """A part of a text.

    Attributes:
        tag: of its element: 'h2', 'p', 'ul' or 'ol'.
        lines: its items; one of a heading and a paragraph.
    """

    tag: str
    lines: tuple[tuple[Span, ...], ...]


def parse_text(text: str) -> tuple[Block, ...]:
    """A text as data.

    >>> parse_text('Build it *quickly*.')[0].lines[0][1]
    Span(tag='em', text='quickly')
    """
    blocks: list[Block] = []
    for tag, line, goes_on in _lines(text):
        if goes_on and blocks:
            last = blocks[-1]
            if tag == 'more':
                joined = (*last.lines[-1], Span('', ' '), *_spans(line))
                blocks[-1] = last._replace(lines=(*last.lines[:-1], joined))
                continue
            if tag == last.tag:
                blocks[-1] = last._replace(lines=(*last.lines, _spans(line)))
                continue
        blocks.append(Block('p' if tag == 'more' else tag, (_spans(line),)))
    return tuple(blocks)


def _lines(text: str) -> Iterator[tuple[str, str, bool]]:
    """The tag of each line, its words, and whether it may go on what stands above it."""
    goes_on = False
    for line in text.splitlines():
        heading, item = _HEADING.fullmatch(line.strip()), _ITEM.fullmatch(line)
        if not line.strip():
            goes_on = False
        elif heading:
            yield 'h2', heading[1], False
            goes_on = False
        elif item:
            yield 'ol' if item[1] else 'ul', item[2], goes_on
            goes_on = True
        else:
            yield 'more', line.strip(), goes_on
            goes_on = True


def _spans(line: str) -> tuple[Span, ...]:
    spans: list[Span] = []
    end = 0
    for found in _SPAN.finditer(line):
        spans.append(Span('', line[end : found.start()]))
        spans.append(Span('strong', found[1]) if found[1] else Span('em', found[2]))
        end = found.end()
    spans.append(Span('', line[end:]))
    return tuple(span for span in spans if span.text)
