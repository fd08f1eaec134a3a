"""Addresses of silhouettes: what they name, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest
from builders import picture
from hypothesis import given
from hypothesis import strategies as st

from blocks_planning.board.stimuli import Stimulus, find_stimuli, installed_sets
from blocks_planning.errors import StimulusError

ARCH = '###\n#.#\n#.#\n'
STEP = '#.\n##\n'
ARCH_READ = picture('###/#.#/#.#')
STEP_READ = picture('#./##')


def one_line(error: StimulusError) -> str:
    """The message of an error, which has one line."""
    message = str(error)
    assert len(message.splitlines()) == 1
    return message


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working directory with some files of silhouettes."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'arch.txt').write_text(ARCH)
    (tmp_path / 'named.txt').write_text(f'tower arch\n{ARCH}')
    (tmp_path / 'two.txt').write_text(f'tower arch\n{ARCH}\n{STEP}')
    (tmp_path / 'many.txt').write_text('\n\n'.join(['#'] * 25))
    (tmp_path / 'bad.txt').write_text('##\n#\n')
    (tmp_path / 'sub').mkdir()
    (tmp_path / 'sub' / 'step.txt').write_text(STEP)
    return tmp_path


def test_a_set_is_all_of_its_silhouettes() -> None:
    found = find_stimuli('cogsci2021')
    assert [stimulus.name for stimulus in found] == [f'cogsci2021/{n}' for n in range(1, 17)]
    assert {(s.board.width, s.board.height) for s in found} == {(8, 8)}
    assert find_stimuli('cogsci2021/9') == [found[8]]
    assert found[8].draw().split('\n')[-1] != '........'


@pytest.mark.parametrize(
    ('address', 'expected'),
    [
        ('arch.txt', [Stimulus('arch.txt', *ARCH_READ)]),
        ('./arch.txt', [Stimulus('./arch.txt', *ARCH_READ)]),
        ('arch.txt/1', [Stimulus('arch.txt/1', *ARCH_READ)]),
        ('named.txt', [Stimulus('named.txt/arch', *ARCH_READ)]),
        (
            'two.txt',
            [Stimulus('two.txt/arch', *ARCH_READ), Stimulus('two.txt/2', *STEP_READ)],
        ),
        ('two.txt/2', [Stimulus('two.txt/2', *STEP_READ)]),
        ('sub/step.txt', [Stimulus('sub/step.txt', *STEP_READ)]),
        ('sub/../two.txt/arch', [Stimulus('sub/../two.txt/arch', *ARCH_READ)]),
    ],
)
def test_a_file_is_named_by_its_path(folder: Path, address: str, expected: list[Stimulus]) -> None:
    assert find_stimuli(address) == expected


def test_an_absolute_path_is_an_address(folder: Path) -> None:
    assert find_stimuli(str(folder / 'two.txt' / '2')) == [
        Stimulus(f'{folder}/two.txt/2', *STEP_READ)
    ]


def test_a_set_goes_before_a_folder_of_its_name(folder: Path) -> None:
    (folder / 'cogsci2021').mkdir()
    assert len(find_stimuli('cogsci2021')) == 16
    assert len(find_stimuli('cogsci2021/9')) == 1


@pytest.mark.parametrize(
    ('address', 'words'),
    [
        pytest.param('', "stimulus '': no such file", id='empty'),
        pytest.param('/', '/: is a directory', id='root'),
        pytest.param('nothing', "stimulus 'nothing': no such file, and no such set", id='set'),
        pytest.param('nothing/9', "stimulus 'nothing/9': no such file", id='member of no set'),
        pytest.param('cogsci2021/17', "stimulus 'cogsci2021/17': ", id='no such member'),
        pytest.param('cogsci2021/', "stimulus 'cogsci2021/': ", id='member without a name'),
        pytest.param('cogsci2021/9/9', "stimulus 'cogsci2021/9/9': no such file", id='too deep'),
        pytest.param('two.txt/step', "has no tower 'step'; it has arch, 2", id='name'),
        pytest.param('many.txt/x', '19, 20 and 5 more', id='name of many'),
        pytest.param('sub', 'sub: is a directory', id='directory'),
        pytest.param('sub/step', "stimulus 'sub/step': no such file", id='in a directory'),
        pytest.param('a\0b', r"stimulus 'a\x00b': no such file", id='NUL'),
        pytest.param('a\0b/9', r"stimulus 'a\x00b/9': no such file", id='NUL in the set'),
        pytest.param('a\nb', r"stimulus 'a\nb': no such file", id='newline'),
        pytest.param('x' * 5000, f"stimulus '{'x' * 196}...: no such file", id='over-long'),
        pytest.param('x' * 300 + '/9', 'no such file', id='over-long set'),
        pytest.param('\ud800', 'no such file', id='lone surrogate'),
        pytest.param('bad.txt', 'bad.txt, line 2, column 2', id='bad file'),
        pytest.param('bad.txt/1', 'bad.txt, line 2, column 2', id='member of a bad file'),
    ],
)
def test_address_that_names_nothing_is_refused(folder: Path, address: str, words: str) -> None:
    with pytest.raises(StimulusError) as caught:
        find_stimuli(address)
    assert words in one_line(caught.value)


@pytest.mark.parametrize('address', ['flat.txt', 'flat.txt/none'])
def test_a_silhouette_without_a_target_cell_is_refused(folder: Path, address: str) -> None:
    (folder / 'flat.txt').write_text(f'tower none\n...\n...\n\ntower step\n{STEP}')
    with pytest.raises(StimulusError, match=r"'flat.txt/none': has no target cell.*one '#'"):
        find_stimuli(address)
    assert find_stimuli('flat.txt/step') == [Stimulus('flat.txt/step', *STEP_READ)]


def test_error_of_an_unknown_set_names_the_sets(folder: Path) -> None:
    with pytest.raises(StimulusError, match=r'there are: .*cogsci2021'):
        find_stimuli('nothing')


def test_sets_of_a_ros_workspace_are_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for prefix, text in (('first', ARCH), ('second', STEP)):
        stimuli = tmp_path / prefix / 'share' / 'blocks_planning' / 'stimuli'
        stimuli.mkdir(parents=True)
        (stimuli / 'mine.txt').write_text(text)
        (stimuli / f'{prefix}.txt').write_text(text)
    prefixes = f'{tmp_path / "first"}:{tmp_path / "missing"}::{tmp_path / "second"}'
    monkeypatch.setenv('AMENT_PREFIX_PATH', prefixes)
    assert {'mine', 'first', 'second', 'cogsci2021'} <= set(installed_sets())
    assert find_stimuli('mine') == [Stimulus('mine/1', *ARCH_READ)]
    assert find_stimuli('second/1') == [Stimulus('second/1', *STEP_READ)]


@given(st.text(max_size=40))
def test_any_address_is_found_or_refused(address: str) -> None:
    try:
        found = find_stimuli(address)
    except StimulusError as error:
        one_line(error)
    else:
        assert found
