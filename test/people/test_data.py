"""The installed data of people: what is known of them, and files that are not as they should be."""

from __future__ import annotations

import gzip
from collections.abc import Callable
from pathlib import Path

import pytest

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import area
from blocks_planning.errors import InvalidInput
from blocks_planning.people import data, orders

HEAD = 'participant,trial,tower,width,height,column,row'


def test_builds_are_those_of_the_study() -> None:
    builds = data.read_builds()
    assert len(builds) == 2520
    assert len({build.builder for build in builds}) == 105
    assert sum(len(build.placements) for build in builds) == 22_739
    assert {build.tower for build in builds} == {'4', '5', '6', '8', '9', '11', '12', '16'}
    assert builds[0].placements[:2] == (Placed(4, 2, 1, 0), Placed(2, 4, 5, 0))


@pytest.mark.parametrize(
    ('measure', 'share'), [('upwards', 0.876), ('inside', 0.774), ('perfect', 0.214)]
)
def test_shares_of_all_builds_are_those_published_with_the_data(
    measure: str, share: float
) -> None:
    counts = [
        orders.MEASURES[measure](data.tasks()[build.tower], build.placements)
        for build in data.read_builds()
    ]
    hits, chances = map(sum, zip(*counts, strict=True))
    assert hits / chances == pytest.approx(share, abs=0.0005)


def test_markings_divide_each_silhouette() -> None:
    markings = data.read_markings()
    assert len(markings) == 488
    assert len({marking.marker for marking in markings}) == 61
    for marking in markings:
        silhouette = data.tasks()[marking.tower].silhouette
        assert sum(marking.parts) == silhouette
        assert sum(map(area, marking.parts)) == area(silhouette)


def test_first_marking_is_drawn_the_right_way_up() -> None:
    first = data.read_markings()[0]
    board = data.tasks()['12'].board
    assert first.parts[2] == board.rectangle(3, 0, 3, 2)


def builds_of(folder: Path, text: str) -> list[data.Build]:
    path = folder / 'own.csv'
    path.write_text(text)
    return data.read_builds(path)


def test_own_file_is_read_trial_by_trial(tmp_path: Path) -> None:
    rows = ['1,1,4,2,1,0,0', '1,1,4,1,2,-3,9', '1,2,4,2,2,0,0', '2,2,4,2,2,0,0']
    builds = builds_of(tmp_path, '\n'.join([HEAD, *rows]))
    assert [(build.builder, len(build.placements)) for build in builds] == [
        ('1', 2),
        ('1', 1),
        ('2', 1),
    ]
    assert builds[0].placements[1] == Placed(1, 2, -3, 9)


@pytest.mark.parametrize(
    ('text', 'said'),
    [
        (f'{HEAD}\n1,1,99,2,1,0,0', "line 2: unknown tower '99'"),
        (f'{HEAD}\n1,1,4,2,1,0,0\n1,1,4,2,1,0,up', 'line 3: expected whole numbers of cells'),
        (f'{HEAD}\n1,1,4,2,1,0', "line 2: missing column 'row'"),
        ('participant,tower\n1,4', "line 2: missing column 'trial'"),
    ],
)
def test_bad_row_is_named(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        builds_of(tmp_path, text)


@pytest.mark.parametrize('chunks', ['11/11', '/'.join(['1' * 8] * 7), '/'.join(['1' * 9] * 8)])
def test_picture_of_another_size_is_refused(tmp_path: Path, chunks: str) -> None:
    path = tmp_path / 'own.csv'
    path.write_text(f'pilot,participant,tower,chunks\nb,1,4,{chunks}\n')
    with pytest.raises(InvalidInput, match='expected 8 rows of 8 digits'):
        data.read_markings(path)


def missing(path: Path) -> None:
    pass


def no_archive(path: Path) -> None:
    path.write_bytes(b'no archive')


def cut_short(path: Path) -> None:
    path.write_bytes(gzip.compress(f'{HEAD}\n1,1,4,2,1,0,0\n'.encode())[:-9])


def no_text(path: Path) -> None:
    path.write_bytes(gzip.compress(b'\xff\xfe\xfa'))


@pytest.mark.parametrize('spoil', [missing, no_archive, cut_short, no_text])
def test_file_that_cannot_be_read_is_named(tmp_path: Path, spoil: Callable[[Path], None]) -> None:
    path = tmp_path / 'own.csv.gz'
    spoil(path)
    with pytest.raises(InvalidInput, match=r'own\.csv\.gz: cannot be read'):
        data.read_builds(path)
