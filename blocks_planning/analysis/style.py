"""Style of figures: colours that colour-blind readers can distinguish, sizes, and saving."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from blocks_planning.extras import extra

with extra('figures'):
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure


# Okabe and Ito (2008).
COLOURS = {'none': '#999999', 'scoping': '#0072B2', 'full': '#D55E00', 'people': '#009E73'}
BLACK = '#000000'
SEARCH_NAMES = {'bfs': 'BFS', 'astar': 'A*'}
MEASURE_LABELS = {
    'success': 'perfect reconstruction\n[share of runs]',
    'action_planning_cost': 'action planning cost\n[states evaluated]',
    'subgoal_planning_cost': 'subgoal planning cost\n[states evaluated]',
    'blocks': 'blocks used\n[blocks]',
    'subgoals': 'subgoals executed\n[subgoals]',
}
_SETTINGS = {
    'font.size': 9,
    'axes.spines.top': False,
    'axes.spines.right': False,
    'axes.titlesize': 10,
    'axes.titlelocation': 'left',
    'legend.frameon': False,
    'figure.constrained_layout.use': True,
    'svg.hashsalt': 'blocks_planning',
}
DPI = 150


def new_figure(width: float, height: float) -> Figure:
    """An empty figure of a size [inches], in the style of this package."""
    with mpl.rc_context(_SETTINGS):
        figure = Figure(figsize=(width, height), layout='constrained')
        FigureCanvasAgg(figure)
    return figure


def styled() -> Any:
    """A context in which axes have the style of this package."""
    return mpl.rc_context(_SETTINGS)


def save_figure(figure: Figure, folder: Path, name: str) -> Path:
    """Write NAME.svg and NAME.png; returns the path of the former."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f'{name}.svg'
    with styled():
        figure.savefig(path, metadata={'Date': None})
        figure.set_layout_engine('none')  # keep the layout
        figure.savefig(path.with_suffix('.png'), dpi=DPI)
    return path


def error_bars(estimate: dict[str, Any]) -> tuple[float, list[list[float]]]:
    """The mean of an estimate, and its interval as distances below and above, for matplotlib."""
    mean, (low, high) = estimate['mean'], estimate['ci']
    return mean, [[max(0.0, mean - low)], [max(0.0, high - mean)]]
