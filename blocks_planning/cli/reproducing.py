"""Commands that run whole studies: that of the paper, and the growth of costs with the board."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import click

from blocks_planning.cli.options import (
    find_all,
    json_option,
    library_option,
    stimuli_argument,
    task_of,
)
from blocks_planning.cli.progress import LIMIT_REACHED, Job, bar, each, time_limit_option
from blocks_planning.cli.sweeping import out_option, print_summary, workers_option
from blocks_planning.errors import ConfigurationError
from blocks_planning.search.result import DEFAULT_BUDGET

if TYPE_CHECKING:
    from blocks_planning.search.policy import ExactPolicy


@click.command(epilog='\b\nExample:\n  blocks-planning reproduce --out results')
@out_option
@click.option('--quick', is_flag=True, help='Use few seeds and values of lambda; takes seconds.')
@workers_option
def reproduce(out: Path, quick: bool, workers: int | None) -> int:
    """Run every experiment of the paper and write a report.

    The command writes report.html, results.json, figures, and the tables of all trials. After an
    interruption, the same command continues. The exit code is 1 if a trial could not be run.
    """
    from blocks_planning.analysis.comparing import count_verdicts
    from blocks_planning.analysis.report import write_report
    from blocks_planning.experiments.exactly import exact_table
    from blocks_planning.experiments.reading import find_sweep, read_sweep
    from blocks_planning.experiments.running import default_workers
    from blocks_planning.experiments.sizes import size_table
    from blocks_planning.experiments.sweeping import run_sweep

    wanted = read_sweep(find_sweep('paper_quick' if quick else 'paper'))
    workers = workers or default_workers()
    start = perf_counter()
    with bar('Trials') as report:
        summary = run_sweep(wanted, out / 'sweep', workers, report=report)
    beyond = read_sweep(find_sweep('beyond_quick' if quick else 'beyond'))
    with bar('Other searches') as report:
        others = run_sweep(beyond, out / 'beyond', workers, report=report)
    swept = perf_counter()
    exact = exact_table(wanted, workers)
    sizes = size_table(wanted.towers[-_QUICK_TOWERS:] if quick else wanted.towers, workers)
    known = perf_counter()
    notes = [_QUICK] if quick else []
    results = write_report(out / 'sweep', out / 'beyond', out, exact, sizes, notes, workers)
    end = perf_counter()
    print_summary(summary, out / 'sweep')
    print_summary(others, out / 'beyond')
    for preset, found in results['presets'].items():
        counted = count_verdicts(found['claims'])
        click.echo(
            f'{preset}: {counted["effects_same"]} of {counted["effects"]} effects are the same, '
            f'{counted["sizes_overlap"]} of {counted["sizes"]} sizes overlap'
        )
    click.echo(
        f'{out / "report.html"}: written in {end - start:.1f} s (trials {swept - start:.1f} s, '
        f'exact values {known - swept:.1f} s, statistics and figures {end - known:.1f} s)'
    )
    return int(summary.failed + others.failed > 0)


_QUICK_TOWERS = 4
"""Number of towers, the last ones, whose sizes a quick run counts: some take seconds."""
_QUICK = (
    'This is a quick run with few seeds and few values of lambda. It only shows that everything '
    'works; do not compare its numbers with the paper.'
)


@click.command(epilog='\b\nExample:\n  blocks-planning growth --out growth')
@out_option
@click.option(
    '--towers', type=click.IntRange(1), default=8, show_default=True, help='Towers per size.'
)
@click.option(
    '--seeds', type=click.IntRange(1), default=2, show_default=True, help='Trials per tower.'
)
@click.option(
    '--largest',
    type=click.IntRange(6, 16),
    default=16,
    show_default=True,
    help='Largest side of a board [cells].',
)
@workers_option
def growth(out: Path, towers: int, seeds: int, largest: int, workers: int | None) -> int:
    """Measure how planning costs grow with the board.

    The towers are generated. The command writes growth.json with fits, figures/growth.svg and .png,
    and the tables of all trials.
    """
    from blocks_planning.analysis.growth import (
        LEAST_SIDES,
        growth_figure,
        growth_table,
        read_growth,
    )
    from blocks_planning.analysis.style import save_figure
    from blocks_planning.experiments.growth import SIDES, growth_sweep
    from blocks_planning.experiments.running import default_workers
    from blocks_planning.experiments.sweeping import run_sweep

    sides = tuple(side for side in SIDES if side <= largest)
    if len(sides) < LEAST_SIDES:
        raise ConfigurationError(
            f'--largest {largest}: leaves the sizes {", ".join(map(str, sides))}; a fit needs '
            f'at least {LEAST_SIDES} sizes; use {SIDES[LEAST_SIDES - 1]} or more'
        )
    with bar('Trials') as report:
        summary = run_sweep(
            growth_sweep(towers, seeds, sides),
            out / 'sweep',
            workers or default_workers(),
            report=report,
        )
    rows = growth_table(read_growth(out / 'sweep'))
    (out / 'growth.json').write_text(json.dumps(rows, indent=1) + '\n', encoding='utf-8')
    path = save_figure(growth_figure(rows, DEFAULT_BUDGET), out / 'figures', 'growth')
    print_summary(summary, out / 'sweep')
    for row in rows:
        click.echo(f'{row["way"]:6} {row["strategy"]:8} {_law_of(row["fit"])}')
    click.echo(f'{path}: written')
    return int(summary.failed > 0)


def _law_of(fit: dict[str, Any] | None) -> str:
    if fit is None:
        return 'not fitted: fewer than 3 sizes have a cost'
    return f'{fit["law"]:11} {fit["base"]:6.2f} (R2 {fit["r2"]:.2f})'


@click.command(
    epilog='\b\nExamples:\n  blocks-planning exact-policy cogsci2021/9\n'
    '  blocks-planning exact-policy cogsci2021 --search random --json\n'
    '  blocks-planning exact-policy cogsci2021/9 --slip 0.05 --slip 0.1'
)
@stimuli_argument
@click.option('--search', type=click.Choice(['bfs', 'random']), default='bfs', show_default=True)
@click.option(
    '--depth',
    type=click.IntRange(1, 64),
    help='Number of placements bfs looks ahead.  [default: 3]',
)
@click.option(
    '--budget',
    type=int,
    default=DEFAULT_BUDGET,
    show_default=True,
    help='Budget b of a solve [states].',
)
@click.option(
    '--limit',
    type=click.IntRange(1),
    default=2_000_000,
    show_default=True,
    help='Largest number of states to examine per tower.',
)
@click.option(
    '--slip',
    'slips',
    type=float,
    multiple=True,
    help='Probability that a block lands one column left or right of its order, 0 to 1; may be '
    'given several times. Compares the best possible policy with bfs and random.',
)
@time_limit_option
@library_option
@json_option
@click.pass_context
def exact_policy(
    context: click.Context,
    addresses: tuple[str, ...],
    search: str,
    depth: int | None,
    budget: int,
    limit: int,
    slips: tuple[float, ...],
    time_limit_s: float | None,
    library: str,
    as_json: bool,
) -> int:
    """Compute success and cost of bfs or random without sampling.

    The output has the success and expected cost of one attempt, and the success of repeated
    attempts within the budget. If a tower needs more states than the limit, or more memory (640 MB
    for costs) or time, its row reports that, and the exit code is 3. With --slip, the output has
    the highest success of any policy in a world where blocks slip, and the success of one attempt
    of bfs and of random.
    """
    if slips:
        from blocks_planning.cli.slipping import print_slips

        given = [name for name in ('search', 'budget') if is_given(context, name)]
        if given:
            raise click.UsageError(
                f'--slip compares all policies by one attempt; remove --{given[0]}'
            )
        tasks = [(one.name, task_of(one, library)) for one in find_all(addresses)]
        return print_slips(tasks, slips, depth, limit, as_json)
    from blocks_planning.search.gauge import Gauge
    from blocks_planning.search.policy import analyse_policy
    from blocks_planning.search.result import Problem
    from blocks_planning.search.searches import make_search

    chosen = make_search(search, {} if depth is None else {'depth': depth})
    jobs = []
    for stimulus in find_all(addresses):
        task, gauge = task_of(stimulus, library), Gauge()
        problem = Problem(task, 0, task.silhouette)
        work = partial(analyse_policy, problem, chosen, budget, limit, gauge=gauge)
        jobs.append(Job(stimulus.name, work, gauge))
    code = 0
    for outcome in each('exact-policy', jobs, len(jobs), time_limit_s):
        found = outcome.result
        if found is None:
            code = LIMIT_REACHED
        if as_json:
            row = {'problem': outcome.problem} if found is None else vars(found)
            click.echo(json.dumps({'stimulus': outcome.name, **row}))
            continue
        said = outcome.problem if found is None else _policy_in_words(found)
        click.echo(f'{outcome.name}: {said}')
    return code


def _policy_in_words(found: ExactPolicy) -> str:
    cost = found.cost_of_success
    return (
        f'one attempt succeeds with probability {found.success:.6g} at {found.cost:,.1f} states'
        + ('' if cost is None else f' ({cost:,.1f} if it succeeds)')
        + f'; solve within {found.budget:,}: {found.within_budget:.6g}'
    )


def is_given(context: click.Context, name: str) -> bool:
    """Whether an option was given on the command line."""
    return context.get_parameter_source(name) is not click.core.ParameterSource.DEFAULT
