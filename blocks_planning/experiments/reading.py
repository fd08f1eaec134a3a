"""Reading the specification of a sweep.

::

    name: lambdas                # of the sweep
    stimuli: [cogsci2021]        # addresses, as on the command line
    library: 1x2,2x1,2x2         # optional; default: the paper's library
    seeds: 32                    # number of seeds, from first_seed upwards
    first_seed: 0                # optional
    experiments:
      - name: bfs                # the tables have this name in a column
        budget: 100000           # optional [states]
        seeds: 8                 # optional, if fewer than in the sweep: its first ones
        searches:
          - {name: bfs, depth: [2, 3]}
        strategies:
          - {name: scoping, lambda: {from: 0, to: 0.008, count: 64}}
        worlds: [{name: simulated}]   # optional; default: every order is obeyed

A setting may be a list, or evenly spaced numbers ``{from, to, count}`` with both ends. Then there
is one search, strategy or world for each value, or for each combination of values if there are
several lists. Paths of stimuli are relative to the working directory.
"""

from __future__ import annotations

from pathlib import Path

from blocks_planning.experiments.spec import Experiment, SweepSpec
from blocks_planning.located import Located, read_yaml
from blocks_planning.resources import resource_directories
from blocks_planning.search.searches import make_own_search
from blocks_planning.subgoals.registry import make_planner
from blocks_planning.trials.script import (
    read_budget,
    read_planners,
    read_seeds,
    read_text,
    read_towers,
    read_whole,
    read_worlds,
)


def find_sweep(name: str) -> Path:
    """The file of a sweep that ships with the package ('paper'), or the path itself."""
    for directory in resource_directories('config'):
        path = directory / 'sweeps' / f'{name}.yaml'
        if path.is_file():
            return path
    return Path(name)


def read_sweep(path: Path) -> SweepSpec:
    """Read a sweep.

    Raises:
        ConfigurationError: naming file, line and key, for an unknown or missing key, a value out of
            range, or two experiments with the same name.
    """
    top = read_yaml(path).entries(
        'name', 'stimuli', 'seeds', 'experiments', optional=('library', 'first_seed')
    )
    towers, seeds = tuple(read_towers(top)), read_seeds(top)
    experiments: list[Experiment] = []
    for item in top['experiments'].items():
        experiment = _experiment(item, len(seeds))
        if experiment.name in {other.name for other in experiments}:
            raise item.fail(f'there is already an experiment {experiment.name!r}')
        experiments.append(experiment)
    return SweepSpec(read_text(top['name']), towers, seeds, tuple(experiments))


def _experiment(item: Located, most_seeds: int) -> Experiment:
    optional = ('budget', 'worlds', 'seeds')
    entries = item.entries('name', 'searches', 'strategies', optional=optional)
    seeds = None
    if 'seeds' in entries:
        seeds = read_whole(entries['seeds'], 'seeds', 1, most_seeds)
    return Experiment(
        name=read_text(entries['name']),
        searches=tuple(read_planners(entries['searches'], make_own_search)),
        strategies=tuple(read_planners(entries['strategies'], make_planner)),
        budget=read_budget(entries),
        worlds=tuple(read_worlds(entries)),
        seeds=seeds,
    )
