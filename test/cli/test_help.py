"""Help, its examples, and the version."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator

import click
import pytest
from command import Run

from blocks_planning import __version__
from blocks_planning.cli import commands
from blocks_planning.trials.flat import flat_settings


def _all_commands() -> Iterator[tuple[str, click.Command]]:
    for name, command in commands.commands.items():
        yield name, command
        if isinstance(command, click.Group):
            for below, inner in command.commands.items():
                yield f'{name} {below}', inner


COMMANDS = dict(_all_commands())


@pytest.mark.parametrize('name', ['', *COMMANDS])
def test_help_has_an_example(run: Run, name: str) -> None:
    for option in ('--help', '-h'):
        done = run(*name.split(), option)
        assert (done.code, done.err) == (0, '')
        assert re.search(rf'^ .*blocks-planning {name}', done.out, re.MULTILINE)
        assert max(map(len, done.out.splitlines())) <= 99


EXAMPLES = [
    line.strip()
    for command in COMMANDS.values()
    for line in (command.epilog or '').splitlines()
    if line.strip().startswith('blocks-planning ')
]


@pytest.mark.parametrize('example', EXAMPLES)
def test_example_is_understood(example: str) -> None:
    words = shlex.split(example.partition('>')[0])[1:]
    name = next(
        name
        for name in sorted(COMMANDS, reverse=True)
        if words[: len(name.split())] == name.split()
    )
    above = click.Context(commands, **commands.context_settings)  # or the options of help differ
    COMMANDS[name].make_context(name, words[len(name.split()) :], parent=above)


def test_help_describes_a_setting_in_the_words_of_each_member(run: Run) -> None:
    said = ' '.join(run('solve', '--help').out.split()).lower()
    texts = {
        one.text.lower()
        for flat in flat_settings(lambda cls: cls.name not in ('human', 'observed', 'external'))
        for one in flat.members.values()
    }
    assert len(texts) > 20
    assert [text for text in texts if text not in said] == []


def test_version(run: Run) -> None:
    assert run('--version') == (0, f'blocks-planning, version {__version__}\n', '')
