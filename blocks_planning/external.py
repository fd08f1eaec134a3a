"""What the strategy and the search ``external`` share: another program stands for them.

The program is a node of the graph. It gets the messages of a trial and answers them; the parts of
this package leave such a trial to it. A record bears the name of the program, and verification
holds it to every rule but its choices.
"""

from __future__ import annotations

from typing import Any

from blocks_planning.errors import ConfigurationError
from blocks_planning.settings import setting


def program_setting() -> Any:
    """The setting with the name of the program."""
    return setting(
        'unnamed',
        'Name of the program, for the record.',
        pattern=r'[A-Za-z0-9_.-]{1,64}',
        expected='a name of 1 to 64 letters, digits, _, . and -',
    )


def out_of_reach(family: str, program: str) -> ConfigurationError:
    """The error when a member that stands for a program is to be run in this process."""
    return ConfigurationError(
        f'{family} external stands for the program {program!r}, which only a graph can reach: '
        'run the trial with blocks-planning run'
    )


def refuse_external(**members: Any) -> None:
    """Refuse a strategy or a search, given under the name of its family, that is another program.

    Raises:
        ConfigurationError: for one that is.
    """
    for family, member in members.items():
        if member.is_external:
            raise out_of_reach(family, member.program)
