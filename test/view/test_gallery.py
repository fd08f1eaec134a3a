from __future__ import annotations

import io
import re
from dataclasses import replace
from pathlib import Path

import pytest
from builders import SQUARE, record
from rich.console import Console

from blocks_planning.errors import ConfigurationError
from blocks_planning.view.gallery import Gallery, print_gallery, save_gallery

LINK = re.compile('\x1b]8;[^;]*;(file://[^\x1b]+)\x1b')


def printed(gallery: Gallery, *, terminal: bool, width: int = 200) -> str:
    file = io.StringIO()
    colours = 'truecolor' if terminal else None
    print_gallery(
        gallery,
        Console(
            file=file,
            force_terminal=terminal,
            color_system=colours,  # type: ignore[arg-type]
            width=width,
        ),
    )
    return file.getvalue()


def test_file_names_say_stimulus_strategy_search_and_seed(tmp_path):
    records = [
        record(SQUARE, stimulus='cogsci2021/9', seed=3),
        record(SQUARE, stimulus='../my towers/塔', strategy='none', search='astar'),
    ]
    gallery = save_gallery(records, tmp_path / 'new' / 'pictures', 16)
    assert [path.name for path in gallery.paths] == [
        'cogsci2021-9-scoping-bfs-seed3.svg',
        'my-towers-none-astar-seed0.svg',
    ]
    assert {path.parent for path in gallery.paths} == {tmp_path / 'new' / 'pictures'}
    assert sorted(gallery.folder.iterdir()) == sorted(gallery.paths)
    assert gallery.left_out == 0


def test_trials_that_differ_in_settings_only_have_pictures_of_their_own(tmp_path):
    records = [record(SQUARE, lam=lam) for lam in (0.1, 0.2, 0.3)]
    first, *others = save_gallery(records, tmp_path, 16).paths
    assert first.stem == 'small-scoping-bfs-seed0'
    assert [path.stem for path in others] == [
        f'{first.stem}-{one.spec.trial_id[:8]}' for one in records[1:]
    ]
    for path, lam in zip((first, *others), (0.1, 0.2, 0.3), strict=True):
        assert f'lambda {lam}' in path.read_text(encoding='utf-8')


def test_a_name_that_is_too_long_for_a_file_keeps_its_end(tmp_path):
    long = replace(record(SQUARE), spec=replace(record(SQUARE).spec, stimulus='x' * 300 + '/arch'))
    [path] = save_gallery([long], tmp_path, 16).paths
    assert path.name.endswith('-arch-scoping-bfs-seed0.svg')
    assert len(path.name) < 100


def test_only_the_first_trials_are_drawn_and_the_others_counted(tmp_path):
    records = [record(SQUARE, seed=seed) for seed in range(5)]
    gallery = save_gallery(records, tmp_path, 2)
    assert len(gallery.paths) == len(list(tmp_path.iterdir())) == 2
    assert gallery.left_out == 3
    said = f'Pictures: {tmp_path} (of the first 2 trials; 3 left out)\n'
    assert printed(gallery, terminal=False, width=20) == said


def test_a_terminal_gets_a_link_to_every_picture(tmp_path):
    gallery = save_gallery([record(SQUARE, seed=seed) for seed in range(3)], tmp_path, 16)
    text = printed(gallery, terminal=True)
    assert [link.split('/')[-1] for link in LINK.findall(text)] == [
        tmp_path.name,
        *(path.name for path in gallery.paths),
    ]
    assert printed(gallery, terminal=False) == f'Pictures: {tmp_path}\n'


@pytest.mark.parametrize('blocked', ['pictures', 'pictures/small-scoping-bfs-seed0.svg'])
def test_what_can_not_be_written_is_named(tmp_path: Path, blocked):
    path = tmp_path / blocked
    if blocked == 'pictures':
        path.write_text('no folder')
    else:
        path.mkdir(parents=True)
    with pytest.raises(ConfigurationError, match=f'^{re.escape(str(path))}: cannot be written: '):
        save_gallery([record(SQUARE)], tmp_path / 'pictures', 16)
