"""Files of other programs: what is read from them, and what is refused where."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from builders import picture
from hypothesis import given
from hypothesis import strategies as st
from strategies import boards

from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.importing.towers import (
    Imported,
    Reading,
    import_file,
    import_text,
    with_different_names,
)
from blocks_planning.errors import StimulusError

STEP = picture('#./##')
BLOCKS: dict[str, Any] = {
    'blocks': [
        {'x': 0, 'y': 0, 'width': 2, 'height': 1, 'colour': 'red'},
        {'x': 0, 'y': 1, 'width': 1, 'height': 1},
    ]
}


def read(folder: Path, name: str, content: Any, reading: Reading | None = None) -> list[Imported]:
    """The towers of a file whose text is given."""
    text = content if isinstance(content, str) else json.dumps(content)
    return import_text(text.removeprefix('\ufeff'), folder / name, reading or Reading())


def test_a_file_is_read_with_its_byte_order_mark(tmp_path: Path) -> None:
    path = tmp_path / 'a.csv'
    path.write_text('\ufeff1,0\n1,1\n', encoding='utf-8')
    assert silhouettes(import_file(path)) == [('a', STEP)]
    with pytest.raises(StimulusError, match='cannot be read'):
        import_file(tmp_path / 'b.csv')


def silhouettes(towers: list[Imported]) -> list[tuple[str, tuple[Board, Mask]]]:
    return [(tower.name, (tower.board, tower.silhouette)) for tower in towers]


@pytest.mark.parametrize(
    ('name', 'content'),
    [
        ('a.json', BLOCKS),
        ('a.json', {'blocks': [dict(block, x=block['x'] - 7) for block in BLOCKS['blocks']]}),
        ('a.json', [[1, 0], [1, 1]]),
        ('a.json', [[2, 0], [1, 3.0]]),
        ('a.json', ['#.', '##']),
        ('a.json', [[0] * 40, [0, 1] + [0] * 38, [0, 1, 1] + [0] * 37, [0] * 40]),
        ('a.json', [[False, False, True], [False, True, True]]),
        ('a.csv', '1,0\n1,1\n'),
        ('a.csv', 'TRUE;FALSE\r\nTRUE;TRUE\r\n'),
        ('a.csv', '#.\n##\n'),
        ('a.csv', '\ufeff"x",\n"x","x"\n'),
        ('a.tsv', '1\t0\n1\t1'),
        ('a.txt', '#.\n##\n'),
    ],
)
def test_every_form_gives_the_step(tmp_path: Path, name: str, content: Any) -> None:
    [found] = read(tmp_path, name, content)
    assert (found.board, found.silhouette) == STEP
    assert found.name == ('1' if name == 'a.txt' else 'a')


def test_a_file_of_several_towers_gives_each_its_name(tmp_path: Path) -> None:
    step = [[1, 0], [1, 1]]
    named = {
        'one': step,
        'my gate': BLOCKS,
        'x': {**BLOCKS, 'name': 'Türme'},
        'deep': [step, step],
    }
    towers = read(tmp_path, 'many.json', named)
    names = ['one', 'my-gate', 'Türme', 'deep-1', 'deep-2']
    assert silhouettes(towers) == [(name, STEP) for name in names]
    assert [tower.name for tower in read(tmp_path, 'm.json', [step, BLOCKS])] == ['m-1', 'm-2']
    towers = read(tmp_path, 'm.csv', '1,0\n1,1\n\n \n1,0\n1,1\n')
    assert silhouettes(towers) == [('m-1', STEP), ('m-2', STEP)]


def test_names_that_are_taken_get_a_number(tmp_path: Path) -> None:
    towers = read(tmp_path, 'a.json', [[1]]) * 3
    assert [tower.name for tower in with_different_names(towers)] == ['a', 'a-2', 'a-3']


@pytest.mark.parametrize(
    ('reading', 'rows'),
    [
        (Reading(), '##./..#'),
        (Reading(y='up'), '..#/##.'),
        (Reading(lists='columns', y='down'), '#./#./.#'),
        (Reading(lists='columns', y='up'), '.#/#./#.'),
        (Reading(inverted=True), '..#/##.'),
    ],
)
def test_orientation_is_as_one_says(tmp_path: Path, reading: Reading, rows: str) -> None:
    [found] = read(tmp_path, 'a.json', [[1, 1, 0], [0, 0, 1]], reading)
    assert (found.board, found.silhouette) == picture(rows)


def test_block_lists_with_y_downwards(tmp_path: Path) -> None:
    [found] = read(tmp_path, 'a.json', BLOCKS, Reading(y='down'))
    assert (found.board, found.silhouette) == picture('##/#.')


def test_a_map_of_free_space_is_read_as_one_by_itself_only(tmp_path: Path) -> None:
    grid = [[True, False, False]]
    [found] = read(tmp_path, 'a.json', grid)
    assert (found.board, found.silhouette) == picture('#/#')
    [found] = read(tmp_path, 'a.json', grid, Reading('rows', 'down', inverted=False))
    assert (found.board, found.silhouette) == picture('#')


def test_a_grid_with_some_booleans_is_no_map_of_free_space(tmp_path: Path) -> None:
    [found] = read(tmp_path, 'a.json', [[True, 0], [1, 1]])
    assert (found.board, found.silhouette) == STEP


def test_margins_stay_if_one_says_so(tmp_path: Path) -> None:
    untrimmed = Reading(trim=False)
    [found] = read(tmp_path, 'a.json', [[0, 0, 0], [0, 1, 0]], untrimmed)
    assert (found.board, found.silhouette) == picture('.../.#.')
    shifted = {'blocks': [{'x': 2, 'y': 1, 'width': 1, 'height': 1}]}
    [found] = read(tmp_path, 'a.json', shifted, untrimmed)
    assert (found.board, found.silhouette) == picture('..#/...')


BLOCK = {'x': 0, 'y': 0, 'width': 1, 'height': 1}


@pytest.mark.parametrize(
    ('name', 'content', 'said'),
    [
        ('a.png', 'x', ': the name must end in one of .json, .csv, .tsv, .txt, got .png'),
        ('a', 'x', ', got none'),
        ('a.json', '{', ', line 1, column 2: is not JSON'),
        ('a.json', '[NaN]', ': NaN is not JSON'),
        ('a.json', '{"a": [[1]], "a": [[1]]}', ": key 'a' appears twice"),
        ('a.json', '[' * 100_000, ': is nested too deeply'),
        ('a.json', '[[1' + '0' * 9_000 + ']]', ', or has too long a number'),
        ('a.json', 3, ': expected a grid (a list of lists) or an object with the key blocks, got 3'),
        ('a.json', [], ', got []'),
        ('a.json', {'t': {}}, '.t: expected a grid'),
        ('a.json', {'a\nb': {}}, r"['a\nb']: expected a grid"),
        ('a.json', {'t': [[1], [1, 0]]}, '.t[1]: expected 1 values as in the first list, got 2'),
        ('a.json', [[[1, 'a']]], '[0][0][1]: expected true or false, a whole number, or a sign'),
        ('a.json', [[None]], '[0][0]: expected true or false'),
        ('a.json', [[0.5]], ', got 0.5'),
        ('a.json', [[0, 0]], ': has no target cell'),
        ('a.json', [[]], ' lists of 1 to 1024 values, got 1 of 0'),
        ('a.json', [[1] * 1025], ', got 1 of 1025'),
        ('a.json', [[1] * 17], ' at most 16 cells, got 17 x 1 without its empty margins'),
        ('a.json', {'blocks': []}, '.blocks: expected a list of 1 to 256 blocks, got []'),
        ('a.json', {'blocks': 'x'}, ".blocks: expected a list of 1 to 256 blocks, got 'x'"),
        ('a.json', {'blocks': [3]}, '.blocks[0]: expected an object with x, y, width'),
        ('a.json', {'blocks': [BLOCK, {'x': 1}]}, ".blocks[1]: missing key 'y'"),
        ('a.json', {'t': {'blocks': [{**BLOCK, 'x': 'a'}]}}, '.t.blocks[0].x: expected a whole'),
        ('a.json', {'blocks': [{**BLOCK, 'y': 0.5}]}, '.blocks[0].y: expected a whole number'),
        ('a.json', {'blocks': [{**BLOCK, 'y': True}]}, ', got True'),
        ('a.json', {'blocks': [{**BLOCK, 'y': 1e9}]}, ' from -10000 to 10000, got 1000000000.0'),
        ('a.json', {'blocks': [{**BLOCK, 'width': 0}]}, '.width: expected a whole number from 1'),
        ('a.json', {'blocks': [{**BLOCK, 'height': 17}]}, ' from 1 to 16, got 17'),
        ('a.json', {'blocks': [BLOCK, BLOCK]}, '.blocks[1]: overlaps blocks[0]'),
        ('a.csv', '', ': is empty'),
        ('a.csv', '1,0\n1,q\n', ', line 2, value 2: expected true or false'),
        ('a.csv', '\n1,0\n1\n', ', line 3: expected 2 values as in the first list, got 1'),
        ('a.csv', '1,"0\n', ', line 1: is not a row of separated values'),
        ('a.csv', '0,0\n\n0,1\n', ', line 1: has no target cell'),
        ('a.txt', '#?\n', ', line 1, column 2: expected'),
    ],
)  # fmt: skip
def test_bad_input_is_refused_where_it_stands(
    tmp_path: Path, name: str, content: Any, said: str
) -> None:
    with pytest.raises(StimulusError) as caught:
        read(tmp_path, name, content)
    message = str(caught.value)
    assert message.startswith(f'{tmp_path / name}')
    assert said in message
    assert len(message.splitlines()) == 1
    assert message.count(str(tmp_path)) == 1


def test_a_block_off_the_board_is_refused_where_margins_stay(tmp_path: Path) -> None:
    content = {'blocks': [{**BLOCK, 'x': -1}]}
    with pytest.raises(StimulusError, match='below or left of 0'):
        read(tmp_path, 'a.json', content, Reading(trim=False))


@given(st.data())
def test_every_form_gives_back_what_was_written(data: st.DataObject) -> None:
    folder = Path()
    board = data.draw(boards())
    mask = data.draw(st.integers(1, board.full))
    filled = dict.fromkeys(board.cells(mask), True)
    columns, rows = range(board.width), range(board.height)
    forms: dict[str, Any] = {
        'blocks': {'blocks': [{'x': x, 'y': y, 'width': 1, 'height': 1} for x, y in filled]},
        'map': [[(x, y) not in filled for y in rows] for x in columns],
        'rows': [[int((x, y) in filled) for x in columns] for y in reversed(rows)],
    }
    for form in ('map', 'rows'):
        [found] = read(folder, 'any.json', forms[form], Reading(trim=False))
        assert (found.board, found.silhouette) == (board, mask)
    table = '\n'.join(','.join(map(str, row)) for row in forms['rows'])
    [found] = read(folder, 'any.csv', table, Reading(trim=False))
    assert (found.board, found.silhouette) == (board, mask)
    trimmed = {
        (found.board, found.silhouette)
        for form in forms.values()
        for found in read(folder, 'any.json', form)
    }
    assert len(trimmed) == 1


@given(st.text(max_size=60) | st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=3),
    lambda inner: st.lists(inner, max_size=3)
    | st.dictionaries(st.sampled_from(['blocks', 'x', 'y', 'width', 'height', '\n']), inner, max_size=5),
    max_leaves=8,
).map(json.dumps))  # fmt: skip
def test_any_text_is_read_or_refused(text: str) -> None:
    for name in ('any.json', 'any.csv'):
        for tower in read_or_refused(Path(), name, text):
            assert tower.silhouette


def read_or_refused(folder: Path, name: str, text: str) -> list[Imported]:
    """The towers of a file; none if it is refused in one line."""
    try:
        return read(folder, name, text)
    except StimulusError as error:
        message = str(error)
    assert len(message.splitlines()) == 1
    return []
