"""The figure of a recovery."""

from __future__ import annotations

from blocks_planning.analysis.recovered import recovery_figure


def test_figure_shows_each_parameter_and_each_share() -> None:
    rows = [
        {'parameter': name, 'true': 0.1, 'fitted': 0.2}
        for name in ('lambda', 'temperature', 'lapse')
    ]
    rates = {'rows': {'rows': 0.9, 'random': 0.1}, 'random': {'rows': 0.0, 'random': 1.0}}
    figure = recovery_figure({'rows': rows}, rates)
    *dots, confusion = figure.axes
    assert [ax.lines[0].get_ydata().tolist() for ax in dots] == [[0.2]] * 3  # type: ignore[union-attr]
    assert [text.get_text() for text in confusion.texts] == ['90', '10', '', '100']
