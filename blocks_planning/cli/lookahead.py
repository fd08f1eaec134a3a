"""The command that runs the experiment with regions and horizons."""

from __future__ import annotations

from pathlib import Path

import click

from blocks_planning.cli.progress import bar
from blocks_planning.cli.sweeping import out_option, print_summary, workers_option

_QUICK = 'This is a quick run with two towers. It only shows that everything works.'


@click.command(epilog='\b\nExample:\n  blocks-planning lookahead --out lookahead')
@out_option
@click.option('--quick', is_flag=True, help='Use two towers and few settings; takes seconds.')
@workers_option
def lookahead(out: Path, quick: bool, workers: int | None) -> int:
    """Measure planners with other regions and longer horizons.

    The command writes report.html, results.json and a figure of success against cost, for worlds
    that obey and worlds where blocks slip. After an interruption, the same command continues. The
    exit code is 1 if a trial could not be run.
    """
    from blocks_planning.analysis.lookahead_report import write_lookahead
    from blocks_planning.experiments.reading import find_sweep, read_sweep
    from blocks_planning.experiments.running import default_workers
    from blocks_planning.experiments.sweeping import run_sweep

    summaries = {}
    for name in ('lookahead_quick',) if quick else ('lookahead', 'lookahead_slips'):
        with bar(f'Trials of {name}') as report:
            summaries[out / name] = run_sweep(
                read_sweep(find_sweep(name)),
                out / name,
                workers or default_workers(),
                report=report,
            )
    results = write_lookahead(list(summaries), out, [_QUICK] if quick else [])
    for folder, summary in summaries.items():
        print_summary(summary, folder)
    for sentence in results['answers']:
        click.echo(sentence)
    click.echo(f'{out / "report.html"}: written')
    return int(any(summary.failed for summary in summaries.values()))
