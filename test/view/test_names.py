"""Long names break between their parts."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.cells import cell_len

from blocks_planning.view.names import broken


@pytest.mark.parametrize(
    ('name', 'width', 'lines'),
    [
        ('cogsci2021/9', 12, ['cogsci2021/9']),
        ('stimuli/of/the/second/experiment.txt/gate', 14, [
            'stimuli/of/',
            'the/second/',
            'experiment.',
            'txt/gate',
        ]),
        ('towers of the week.txt/a', 8, ['towers ', 'of the ', 'week.', 'txt/a']),
        ('a-tower_of-two/1', 8, ['a-tower_', 'of-two/1']),
        ('incomprehensibilities/1', 8, ['incompre', 'hensibil', 'ities/1']),
        ('塔塔塔塔/1', 8, ['塔塔塔塔', '/1']),
        ('', 8, ['']),
    ],
)  # fmt: skip
def test_a_name_breaks_behind_a_sign(name: str, width: int, lines: list[str]) -> None:
    assert broken(name, width).split('\n') == lines


@given(st.text('ab/-_. 塔', max_size=60), st.integers(4, 20))
def test_nothing_is_left_out_and_every_line_fits(name: str, width: int) -> None:
    lines = broken(name, width).split('\n')
    assert ''.join(lines) == name
    assert all(cell_len(line.rstrip()) <= width for line in lines)
