"""Visual scoping of block towers: boards, searches, subgoal planners and trials.

The package reproduces the planners of Binder, Mattar, Kirsh and Fan (2021), *Visual scoping
operations for physical assembly*. The names below are all that a notebook needs; docs/python.md
shows them at work.

==================  ==============================================================================
``find_stimuli``    silhouettes, by an address such as 'cogsci2021/9' or the path of a file
``Board``           a grid of cells; ``Board(4, 3).parse(rows)`` gives a silhouette from a picture
``Block``           a block of a library, width x height [cells]
``Task``            a board, the silhouette to rebuild, and the library of blocks
``make_search``     an action-level search, from its name and settings
``make_strategy``   a subgoal planner, from its name and settings
``make_world``      a world, from its name and settings
``TrialSpec``       a trial: task, strategy, search, seed, budget, world
``decide``          the first decision of a trial: every candidate subgoal, and the choice
``run_trial``       run a trial; gives its record
``run_trials``      run several trials; they share solves
``read_records``    the records of a file
``contradictions``  what is wrong with a record; empty if it holds
``frames``          records as pandas frames: trials, decisions, candidates, placements, ...
``draw``            the end of a trial as a picture
``save_picture``    a trial as a .png, .svg, .pdf or .gif file
==================  ==============================================================================

A name is imported when it is first used, so that ``import blocks_planning`` is instant.
"""

from importlib import import_module as _import_module
from typing import Any as _Any

__version__ = '0.1.0'

_HOMES = {
    'Block': 'board.blocks',
    'Board': 'board.geometry',
    'Task': 'board.task',
    'TrialSpec': 'trials.spec',
    'contradictions': 'trials.verify',
    'decide': 'trials.following',
    'draw': 'view.picture',
    'find_stimuli': 'board.stimuli',
    'frames': 'experiments.frames',
    'make_search': 'search.searches',
    'make_strategy': 'subgoals.registry',
    'make_world': 'worlds.world',
    'read_records': 'trials.reading',
    'run_trial': 'trials.local',
    'run_trials': 'trials.following',
    'save_picture': 'view.picture',
}
__all__ = list(_HOMES)


def __getattr__(name: str) -> _Any:
    if name not in _HOMES:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    value = getattr(_import_module(f'{__name__}.{_HOMES[name]}'), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOMES})
