"""The ``blocks-planning`` command.

Results go to stdout, progress and errors to stderr. Exit codes: 0 done, 1 a planner did not
succeed, or a record is inconsistent, 2 bad input, 3 a limit (of states, memory or time) was
reached, 130 interrupted.
"""

from __future__ import annotations

import sys
from typing import NoReturn

import click

from blocks_planning import __version__
from blocks_planning.cli.counting import count, exact
from blocks_planning.cli.embodiment import robot_study
from blocks_planning.cli.fitting import fit
from blocks_planning.cli.graph import run
from blocks_planning.cli.inspecting import draw, verify
from blocks_planning.cli.lookahead import lookahead
from blocks_planning.cli.progress import LIMIT_REACHED
from blocks_planning.cli.reproducing import exact_policy, growth, reproduce
from blocks_planning.cli.running import solve, watch
from blocks_planning.cli.stimuli import stimuli
from blocks_planning.cli.study import study
from blocks_planning.cli.sweeping import sweep
from blocks_planning.cli.uncertainty import uncertain
from blocks_planning.errors import BlocksPlanningError, LimitExceeded

BAD_INPUT = 2
INTERRUPTED = 130


@click.group(
    context_settings={'help_option_names': ['-h', '--help'], 'max_content_width': 99},
    epilog='To begin: blocks-planning watch cogsci2021/9',
)
@click.version_option(__version__, prog_name='blocks-planning')
def commands() -> None:
    """Rebuild block towers from their silhouettes, one visual scope at a time.

    A STIMULUS is a set of silhouettes that ships with the package (cogsci2021), one of a set
    (cogsci2021/9), or the path of a text file with pictures drawn with '#' and '.'.
    """


for command in (
    watch,
    solve,
    run,
    exact,
    exact_policy,
    count,
    stimuli,
    verify,
    draw,
    sweep,
    reproduce,
    growth,
    uncertain,
    lookahead,
    robot_study,
    fit,
    study,
):
    commands.add_command(command)


def main() -> None:
    """Run the command and exit with its code; errors made by the user take one line."""
    try:
        code = commands.main(prog_name='blocks-planning', standalone_mode=False)
    except BlocksPlanningError as error:
        click.echo(f'Error: {error}', err=True)
        code = LIMIT_REACHED if isinstance(error, LimitExceeded) else BAD_INPUT
    except click.ClickException as error:
        error.show()
        code = error.exit_code
    except (KeyboardInterrupt, click.Abort):
        click.echo('Interrupted.', err=True)
        code = INTERRUPTED
    except BrokenPipeError:  # the reader of the output has closed it
        sys.stderr.close()
        code = 0
    _leave(code)


def _leave(code: int) -> NoReturn:
    runtime = sys.modules.get('blocks_planning.ros.runtime.process')
    if runtime is not None:
        runtime.leave_if_up(code)
    sys.exit(code)
