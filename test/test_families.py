"""A setting that is added to a class reaches everything, with no other edit."""

from __future__ import annotations

import importlib
import json
import sys
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar

import click
import pytest
from builders import CHAIR, spec
from click.testing import CliRunner

from blocks_planning.cli.options import planner_options, specs_of
from blocks_planning.errors import ConfigurationError
from blocks_planning.experiments.tables import make_tables
from blocks_planning.families import Registry
from blocks_planning.search.searches import SEARCHES, BreadthFirst
from blocks_planning.settings import Configured, setting, settings_of
from blocks_planning.subgoals.registry import STRATEGIES
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.reading import record_from_json
from blocks_planning.trials.script import read_script
from blocks_planning.trials.settings_table import markdown
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.verify import contradictions
from blocks_planning.view.captions import search_of, strategy_of
from blocks_planning.view.tables import print_summary

ROOT = Path(__file__).resolve().parents[1]


@dataclass(frozen=True)
class Patient(BreadthFirst):
    """Looks ahead, and takes its time."""

    name: ClassVar[str] = 'patient'
    patience: float = setting(1.5, 'How long it waits.', least=0, unit='s')
    mood: str = setting('calm', 'How it feels.', choices=('calm', 'cross'))


@dataclass(frozen=True)
class Bold(Scoping):
    """Scopes boldly."""

    name: ClassVar[str] = 'bold'
    courage: int = setting(3, 'How bold it is.', least=1, most=9, unit='lions')
    loud: bool = setting(False, 'Whether it shouts.')


@pytest.fixture(autouse=True)
def _made_up() -> Iterator[None]:
    with SEARCHES.added(Patient), STRATEGIES.added(Bold):
        yield


GIVEN = [
    *('--strategy', 'bold', '--courage', '7', '--loud', 'true', '--lambda', '0.25'),
    *('--search', 'patient', '--patience', '2.5', '--mood', 'cross', '--depth', '1'),
]


def trials_of(*words: str) -> list[TrialSpec]:
    """The trials that a command with planner options would run."""
    found: list[TrialSpec] = []

    @click.command()
    @planner_options
    def command(**options: Any) -> None:
        found.extend(specs_of(('cogsci2021/2',), 1, options))

    done = CliRunner().invoke(command, words, catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return found


def made_up_trial() -> TrialSpec:
    strategy = STRATEGIES.make('bold', {'courage': 7, 'loud': True, 'lambda': 0.25})
    search = SEARCHES.make('patient', {'patience': 2.5, 'mood': 'cross', 'depth': 1})
    return replace(spec(CHAIR), strategy=strategy, search=search)


def test_options_of_the_command_line_and_their_help() -> None:
    (trial,) = trials_of(*GIVEN)
    made = made_up_trial()
    assert (trial.strategy, trial.search) == (made.strategy, made.search)

    @click.command()
    @planner_options
    def command(**_: Any) -> None:
        """Do nothing."""

    text = ' '.join(CliRunner().invoke(command, ['--help']).output.split())
    for part in (
        '--courage INTEGER How bold it is. [default: 3 for bold]',
        '--mood [calm|cross]',
        '--loud BOOL',
    ):
        assert part in text
    refused = CliRunner().invoke(command, ['--strategy', 'bold', '--mood', 'angry'])
    assert refused.exit_code == 2


def test_keys_of_scripts_and_sweeps(tmp_path: Path) -> None:
    path = tmp_path / 'script.yaml'
    path.write_text(
        textwrap.dedent(
            """\
            stimuli: [cogsci2021/2]
            seeds: 1
            searches:
              - {name: patient, patience: [0.5, 2.5], mood: cross}
            strategies:
              - {name: bold, courage: {from: 1, to: 9, count: 2}}
            """
        ),
        encoding='utf-8',
    )
    with pytest.raises(ConfigurationError, match='courage must be a whole number from 1 to 9'):
        read_script(path)
    path.write_text(path.read_text().replace('{from: 1, to: 9, count: 2}', '[1, 9]'))
    trials = read_script(path)
    assert [
        (settings_of(t.strategy)['courage'], settings_of(t.search)['patience']) for t in trials
    ] == [
        (1, 0.5),
        (1, 2.5),
        (9, 0.5),
        (9, 2.5),
    ]
    path.write_text(path.read_text().replace('mood: cross', 'mood: angry'))
    with pytest.raises(ConfigurationError, match="key 'mood': mood must be one of calm, cross"):
        read_script(path)


def test_part_of_the_trial_id() -> None:
    made = made_up_trial()
    ids = {
        made.trial_id,
        replace(made, strategy=replace(made.strategy, courage=8)).trial_id,  # type: ignore[type-var]
        replace(made, strategy=replace(made.strategy, loud=False)).trial_id,  # type: ignore[type-var]
        replace(made, search=replace(made.search, patience=0.0)).trial_id,  # type: ignore[type-var]
        replace(made, search=replace(made.search, mood='calm')).trial_id,  # type: ignore[type-var]
    }
    assert len(ids) == 5


def test_in_the_record_and_read_back_and_verified() -> None:
    record = run_trial(made_up_trial())
    data = json.loads(record.to_line())
    assert data['strategy_settings']['courage'] == 7
    assert data['search_settings'] == {
        'depth': 1,
        'dead_ends': 'worst',
        'patience': 2.5,
        'mood': 'cross',
    }
    assert record_from_json(data, 'x') == record
    assert list(contradictions(record)) == []
    data['strategy_settings']['courage'] = 10
    with pytest.raises(ConfigurationError, match='courage must be'):
        STRATEGIES.make('bold', data['strategy_settings'])


def test_columns_of_the_tables() -> None:
    trials = make_tables('made up', [run_trial(made_up_trial()), run_trial(spec(CHAIR))]).trials
    rows = trials.to_pylist()
    assert [row['courage'] for row in rows] == [7, None]
    assert [row['loud'] for row in rows] == [True, None]
    assert [row['patience'] for row in rows] == [2.5, None]
    assert [row['mood'] for row in rows] == ['cross', None]


def test_in_captions_summaries_and_documentation(capsys: pytest.CaptureFixture[str]) -> None:
    made = made_up_trial()
    assert 'courage 7' in strategy_of(made)
    assert 'patience 2.5, mood cross' in search_of(made)
    print_summary([run_trial(made)])
    assert 'courage 7' in ' '.join(capsys.readouterr().out.split())
    assert (
        '| `courage` | a whole number from 1 to 9 | `3` | lions | How bold it is. |' in markdown()
    )


# Plug-ins of other distributions.


@pytest.fixture
def distribution(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder on the path with an installed distribution of three plug-ins, two of them broken."""
    info = tmp_path / 'made_up-1.0.dist-info'
    info.mkdir()
    (info / 'METADATA').write_text('Metadata-Version: 2.1\nName: made-up\nVersion: 1.0\n')
    (info / 'entry_points.txt').write_text(
        '[made_up.things]\n'
        'good = made_up_plugin:Good\n'
        'missing = made_up_nowhere:Missing\n'
        'other = made_up_plugin:Good\n'
    )
    (tmp_path / 'made_up_plugin.py').write_text(
        'class Good:\n    """Good."""\n    name = "good"\n'
    )
    monkeypatch.setattr(sys, 'path', [str(tmp_path), *sys.path])
    importlib.invalidate_caches()
    monkeypatch.delitem(sys.modules, 'made_up_plugin', raising=False)
    return tmp_path


def test_plug_ins_are_found_by_their_entry_points(distribution: Path) -> None:
    family = Registry('thing', 'made_up.things')
    assert list(family) == ['good']
    assert family['good'].__module__ == 'made_up_plugin'
    assert family.broken['missing'].startswith('ModuleNotFoundError')
    assert family.broken['other'] == "its class is named 'good'"
    with pytest.raises(
        ConfigurationError, match='its plug-in cannot be loaded: ModuleNotFoundError'
    ):
        family.find('missing')


def test_names_must_be_words_and_unique() -> None:
    for name in ('', 'a b', '1st', 'worst-case'):
        cls = type('Odd', (Configured,), {'name': name})
        with pytest.raises(ConfigurationError, match='letters, digits and _'):
            SEARCHES.add(cls)
    with pytest.raises(ConfigurationError, match="search 'patient' exists already"):
        SEARCHES.add(Patient)


def test_documentation_lists_every_setting() -> None:
    with_made_up = markdown()
    for name in ('patient', 'bold'):
        assert f'### {name}\n' in with_made_up
    page = (ROOT / 'docs' / 'settings.md').read_text(encoding='utf-8')
    listed, made = _sections(page), _sections(with_made_up)
    assert set(made) - set(listed) == {'patient', 'bold'}
    for name, section in listed.items():
        assert section == made[name], 'make docs/settings.md again, as it says'


def _sections(page: str) -> dict[str, str]:
    """The text below each heading of a member."""
    parts = [part.partition('\n## ')[0].strip() for part in page.split('\n### ')[1:]]
    return {part.partition('\n')[0]: part for part in parts}
