"""Two small towers as text and as they are read, and how a text is refused."""

from __future__ import annotations

import pytest
from builders import picture
from hypothesis import strategies as st
from strategies import boards

from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.pictures import parse_silhouettes
from blocks_planning.errors import StimulusError

ARCH = '###\n#.#\n#.#\n'
STEP = '#.\n##\n'
ARCH_READ = picture('###/#.#/#.#')
STEP_READ = picture('#./##')


def refused(text: str, origin: str = 'towers') -> str:
    """The message with which a text is refused."""
    with pytest.raises(StimulusError) as caught:
        parse_silhouettes(text, origin)
    return one_line(caught.value)


def one_line(error: StimulusError) -> str:
    """The message of an error, which has one line."""
    message = str(error)
    assert len(message.splitlines()) == 1
    return message


@st.composite
def drawn(draw: st.DrawFn) -> tuple[Board, Mask]:
    board = draw(boards())
    return board, draw(st.integers(0, board.full))
