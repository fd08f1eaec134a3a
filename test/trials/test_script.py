"""Trial scripts: what they expand to, and what is refused where."""

from __future__ import annotations

import re
from itertools import product
from pathlib import Path

import pytest
from builders import spec
from source_imports import ROOT

from blocks_planning.board.blocks import PAPER_LIBRARY, Block
from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.errors import ConfigurationError
from blocks_planning.search.result import DEFAULT_BUDGET
from blocks_planning.subgoals.human import Human
from blocks_planning.subgoals.regions import Rectangles
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials.script import read_script, read_session
from blocks_planning.trials.spec import TrialSpec

GOOD = """\
stimuli: [cogsci2021/5]
seeds: 1
searches:
  - {name: bfs, depth: 2}
strategies:
  - {name: scoping, lambda: 0.002}
"""


def read(folder: Path, text: str) -> list[TrialSpec]:
    """The trials of a script."""
    path = folder / 'trials.yaml'
    path.write_text(text, encoding='utf-8')
    return read_script(path)


def test_least_that_a_script_says(tmp_path: Path) -> None:
    (trial,) = read(tmp_path, GOOD)
    (stimulus,) = find_stimuli('cogsci2021/5')
    assert trial == TrialSpec(
        stimulus='cogsci2021/5',
        task=trial.task,
        strategy=spec(strategy='scoping', lam=0.002).strategy,
        search=spec(search='bfs', depth=2).search,
        seed=0,
        budget=DEFAULT_BUDGET,
    )
    assert (trial.task.board, trial.task.silhouette) == (stimulus.board, stimulus.silhouette)
    assert trial.task.library == PAPER_LIBRARY


@pytest.mark.parametrize(
    'settings', ['regions: rectangles, min_cells: 4', 'min_cells: 4, regions: rectangles']
)
def test_setting_of_a_region_family_is_one_of_the_strategy(tmp_path: Path, settings: str) -> None:
    (trial,) = read(tmp_path, GOOD.replace('lambda: 0.002', settings))
    assert trial.strategy == Scoping(regions=Rectangles(min_cells=4))
    with pytest.raises(ConfigurationError, match=r"line 6, key 'min_cells': min_cells must be"):
        read(tmp_path, GOOD.replace('lambda: 0.002', settings.replace('4', '0')))


def test_order_is_strategies_searches_stimuli_seeds(tmp_path: Path) -> None:
    trials = read(
        tmp_path,
        """\
        stimuli: [cogsci2021/9, cogsci2021/2]
        library: 2x1,1x2
        seeds: 2
        first_seed: 7
        budget: 500
        searches:
          - {name: random}
          - {name: bfs, depth: [3, 1]}
        strategies:
          - {name: none}
          - {name: scoping, lambda: {from: 0, to: 1, count: 3}, commit: [action, subgoal]}
        """,
    )
    strategies = [
        ('none', None, None),
        *(('scoping', lam, commit) for lam in (0.0, 0.5, 1.0) for commit in ('action', 'subgoal')),
    ]
    bfs = {'dead_ends': 'worst'}
    searches = [('random', {}), ('bfs', {'depth': 3, **bfs}), ('bfs', {'depth': 1, **bfs})]
    expected = list(product(strategies, searches, ('cogsci2021/9', 'cogsci2021/2'), (7, 8), [500]))
    found = []
    for trial in trials:
        said = trial.to_json()
        settings = said['strategy_settings']
        strategy = (said['strategy'], settings.get('lambda'), settings.get('commit'))
        search = (said['search'], said['search_settings'])
        found.append((strategy, search, said['stimulus'], said['seed'], said['budget']))
    assert found == expected
    assert {trial.task.library for trial in trials} == {(Block(2, 1), Block(1, 2))}


def test_whole_set_and_a_file_of_ones_own(tmp_path: Path) -> None:
    path = tmp_path / 'towers.txt'
    path.write_text('tower a\n##\n##\n\ntower b\n#.\n#.\n', encoding='utf-8')
    trials = read(tmp_path, GOOD.replace('cogsci2021/5', f'cogsci2021, {path}'))
    numbers = [f'cogsci2021/{number}' for number in range(1, 17)]
    assert [trial.stimulus for trial in trials[:16]] == numbers
    assert len(trials) == 18


def test_last_seed_is_the_largest_there_is(tmp_path: Path) -> None:
    trials = read(tmp_path, GOOD.replace('seeds: 1', f'seeds: 2\nfirst_seed: {2**64 - 2}'))
    assert [trial.seed for trial in trials] == [2**64 - 2, 2**64 - 1]


@pytest.mark.parametrize('name', ['demo', 'all_towers'])
def test_scripts_that_ship_are_good(name: str) -> None:
    trials = read_script(ROOT / 'config' / 'trials' / f'{name}.yaml')
    assert len({trial.trial_id for trial in trials}) == len(trials) >= 3


REFUSED: list[tuple[str, str, str, str]] = [
    # What is replaced, by what; then the line with the key, and what is said about it.
    ('seeds: 1', 'seeds: 1\nseed: 4', "line 3, key 'seed'", 'unknown key'),
    ('seeds: 1', 'seeds: 1\nseeds: 1', "line 3, key 'seeds'", 'appears twice'),
    ('seeds: 1\n', '', 'line 1', "missing key 'seeds'"),
    ('seeds: 1', 'seeds: 0', "line 2, key 'seeds'", 'seeds must be a whole number .*, got 0'),
    ('seeds: 1', 'seeds: many', "line 2, key 'seeds'", "got 'many'"),
    ('seeds: 1', 'seeds: 1.0', "line 2, key 'seeds'", r'got 1\.0'),
    ('seeds: 1', 'seeds: true', "line 2, key 'seeds'", 'got True'),
    ('seeds: 1', 'seeds:', "line 2, key 'seeds'", 'got None'),
    ('seeds: 1', 'seeds: [1]', "line 2, key 'seeds'", r'got \[1\]'),
    ('seeds: 1', 'seeds: 2000000', "line 2, key 'seeds'", 'got 2000000'),
    ('seeds: 1', 'seeds: 1\nfirst_seed: -1', "line 3, key 'first_seed'", 'got -1'),
    ('seeds: 1', f'seeds: 2\nfirst_seed: {2**64 - 1}', "line 2, key 'seeds'", 'the last seed'),
    ('seeds: 1', 'seeds: 1\nbudget: -5', "line 3, key 'budget'", 'budget must be .*, got -5'),
    ('seeds: 1', 'seeds: 1\nbudget: .inf', "line 3, key 'budget'", 'got inf'),
    ('seeds: 1', 'seeds: 1\nlibrary: 1y2', "line 3, key 'library'", "got '1y2'"),
    ('seeds: 1', 'seeds: 1\nlibrary: 1x2,1x2', "line 3, key 'library'", '1x2 is listed twice'),
    ('seeds: 1', 'seeds: 1\nlibrary: 1x17', "line 3, key 'library'", '1x17'),
    ('seeds: 1', 'seeds: 1\nlibrary: 3', "line 3, key 'library'", 'expected text, got 3'),
    ('[cogsci2021/5]', '[]', "line 1, key 'stimuli'", 'at least one item'),
    ('[cogsci2021/5]', 'cogsci2021/5', "line 1, key 'stimuli'", 'expected a list'),
    ('[cogsci2021/5]', '[cogsci2021/99]', "line 1, key 'stimuli'", 'cogsci2021/99'),
    ('[cogsci2021/5]', '[nowhere.txt]', "line 1, key 'stimuli'", 'nowhere.txt'),
    ('[cogsci2021/5]', '[5]', "line 1, key 'stimuli'", 'expected text, got 5'),
    ('[cogsci2021/5]', '[cogsci2021/5, cogsci2021/5]', 'line 1', 'a trial twice'),
    ('name: bfs', 'name: luck', "line 4, key 'name'", "search must be one of .*, got 'luck'"),
    ('name: bfs, ', '', 'line 4', "missing key 'name'"),
    ('- {name: bfs, depth: 2}', '- bfs', 'line 4', "expected keys with values, got 'bfs'"),
    ('depth: 2', 'depth: 65', "line 4, key 'depth'", 'depth must be .*, got 65'),
    ('depth: 2', 'depth: [1, deep]', 'line 4', "depth must be .*, got 'deep'"),
    ('depth: 2', 'depth: [2, 2]', 'line 1', 'a trial twice'),
    ('depth: 2', 'depth: []', "line 4, key 'depth'", 'at least one item'),
    ('depth: 2', 'width: 2', "line 4, key 'width'", "has no setting 'width'; it has depth"),
    ('depth: 2', 'depth: {from: 1, to: 2}', "line 4, key 'depth'", "missing key 'count'"),
    ('lambda: 0.002', 'lambda: -1', "line 6, key 'lambda'", 'lambda must be .*, got -1'),
    ('lambda: 0.002', 'lambda: .nan', "line 6, key 'lambda'", 'got nan'),
    ('lambda: 0.002', 'lambda: 2e-3', "line 6, key 'lambda'", "got '2e-3'"),
    ('lambda: 0.002', 'lambda: [0, 0.0]', 'line 1', 'a trial twice'),
    ('lambda: 0.002', 'lambda: {from: 0, to: x, count: 2}', "line 6, key 'to'", "got 'x'"),
    ('lambda: 0.002', 'lambda: {from: 0, to: 1, count: 1}', "line 6, key 'count'", 'got 1'),
    ('lambda: 0.002', 'commit: never', "line 6, key 'commit'", "got 'never'"),
    ('name: scoping', 'name: none', "line 6, key 'lambda'", "has no setting 'lambda'"),
]


@pytest.mark.parametrize(
    ('old', 'new', 'place', 'said'),
    [pytest.param(*case, id=case[1].replace('\n', ' ') or case[3]) for case in REFUSED],
)
def test_mistake_is_named_where_it_stands(
    old: str, new: str, place: str, said: str, tmp_path: Path
) -> None:
    assert old in GOOD
    with pytest.raises(ConfigurationError) as refused:
        read(tmp_path, GOOD.replace(old, new, 1))
    text = str(refused.value)
    assert text.startswith(f'{tmp_path / "trials.yaml"}, {place}')
    assert text.count('trials.yaml') == 1
    assert re.search(said, text)
    assert '\n' not in text


@pytest.mark.parametrize(
    ('text', 'said'),
    [
        ('', 'is empty'),
        ('# nothing\n', 'is empty'),
        ('[1, 2]\n', 'line 1: expected keys with values'),
        ('seeds: [1\n', 'line 2: is not YAML'),
        ('seeds: !!python/object:os.system 1\n', 'line 1'),
        ('a: &x [*x]\n', 'nested too deeply'),
        ('? [1, 2]\n: 3\n', ''),
        ('seeds: 2001-99-99\n', "line 1, key 'seeds': '2001-99-99' is not a value"),
        ('a: ' + '[' * 3000 + ']' * 3000, 'nested too deeply'),
        ('<<: {seeds: 1}\n', "key '<<': unknown key"),
        ('a: 1\n---\nb: 1\n', 'is not YAML'),
        ('seeds: ' + '9' * 5000 + '\n', "line 1, key 'seeds'"),
    ],
)
def test_what_is_no_script_is_refused(text: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError) as refused:
        read(tmp_path, text)
    assert str(tmp_path / 'trials.yaml') in str(refused.value)
    assert said in str(refused.value)
    assert '\n' not in str(refused.value)


def test_file_that_can_not_be_read_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=r'nowhere\.yaml: cannot be read'):
        read_script(tmp_path / 'nowhere.yaml')
    (tmp_path / 'bytes.yaml').write_bytes(b'seeds: \xff')
    with pytest.raises(ConfigurationError, match=r'bytes\.yaml: is not a text file'):
        read_script(tmp_path / 'bytes.yaml')


def test_more_trials_than_anyone_has_time_for_are_refused(tmp_path: Path) -> None:
    text = GOOD.replace('seeds: 1', 'seeds: 1000000').replace('cogsci2021/5', 'cogsci2021')
    with pytest.raises(ConfigurationError, match='describes more than 10000000 trials'):
        read(tmp_path, text)


def test_pause_between_trials(tmp_path: Path) -> None:
    path = tmp_path / 'trials.yaml'
    path.write_text(GOOD)
    assert read_session(path).pause_s == 0.0
    path.write_text(GOOD + 'pause_s: 2.5\n')
    assert read_session(path).pause_s == 2.5
    assert read_session(path).trials == read_script(path)


@pytest.mark.parametrize('pause', ['-1', '1e9', 'long', '.nan', '[1]', 'true'])
def test_pause_that_can_not_be_is_refused(pause: str, tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=r"line 7, key 'pause_s': expected"):
        read(tmp_path, GOOD + f'pause_s: {pause}\n')


def test_participant_takes_the_place_of_the_scripted_one(tmp_path: Path) -> None:
    path = tmp_path / 'trials.yaml'
    path.write_text(GOOD + '  - {name: human, participant: nobody, costs: hidden}\n')
    planner, person = read_script(path, 'P07')
    assert planner.strategy == read(tmp_path, GOOD)[0].strategy
    assert person.strategy == Human('P07', 'hidden')
    path.write_text(GOOD + '  - {name: human, costs: hidden}\n')
    assert read_script(path)[1].strategy == Human('', 'hidden')
    for code, said in (('Jane Doe', 'participant must be a code'), ('x' * 33, 'participant must')):
        with pytest.raises(ConfigurationError, match=said):
            read_script(path, code)
