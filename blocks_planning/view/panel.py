"""The panel beside the board in a terminal: the trial, its progress, and the last decision."""

from __future__ import annotations

from textwrap import wrap

from rich.style import Style
from rich.text import Text

from blocks_planning.subgoals.decision import Decision
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view import captions, palette
from blocks_planning.view.palette import Signs
from blocks_planning.view.scene import Scene

MIN_WIDTH = 36
"""Least width of a panel with all columns of a typical table [characters]."""

_STATUS_STYLES = {
    TrialStatus.BUILDING: Style(bold=True),
    TrialStatus.SUCCESS: Style(bold=True, color=palette.GOOD),
}
_FAILED = Style(bold=True, color=palette.BAD)


def panel(scene: Scene, width: int, height: int, signs: Signs = palette.UNICODE) -> Text:
    """Draw the panel of a scene.

    Args:
        scene: the scene.
        width: largest width of a line [characters].
        height: largest number of lines. If there are too many candidates, the rest are counted.
        signs: the characters of the terminal.

    Returns:
        Lines without a newline at the end.
    """
    lines = _lines_about_trial(scene, width, signs)
    if scene.decision is not None:
        lines += [Text(), *_lines_about(scene.decision, width, height - len(lines) - 1, signs)]
    for line in lines:
        line.truncate(width)
    return Text('\n', no_wrap=True, overflow='crop').join(lines[: max(height, 0)])


def _lines_about_trial(scene: Scene, width: int, signs: Signs) -> list[Text]:
    spec, record = scene.spec, scene.record
    status = Text(captions.STATUS_WORDS[scene.status])
    status.stylize(_STATUS_STYLES.get(scene.status, _FAILED))
    status.append(_activity(scene))
    return [
        Text(captions.stimulus_of(spec, width, signs), Style(bold=True)),
        *_wrapped('strategy   ', captions.strategy_of(spec), width),
        *_wrapped('search     ', captions.search_of(spec), width),
        Text('status     ').append_text(status),
        Text(f'blocks     {record.blocks:,}'),
        Text(f'subgoals   {record.subgoals:,}'),
        Text(f'action planning cost   {record.action_planning_cost:>13,}'),
        Text(f'subgoal planning cost  {record.subgoal_planning_cost:>13,}'),
    ]


def _activity(scene: Scene) -> str:
    """The current activity, to follow the status."""
    if scene.status is not TrialStatus.BUILDING:
        return ''
    if scene.subgoal is None or not scene.region:
        return ', deciding'
    return f' {scene.label}'


def _wrapped(label: str, text: str, width: int) -> list[Text]:
    """A label and a text, on as many lines as needed."""
    indent = ' ' * len(label)
    lines = wrap(text, max(width, 2 * len(label)), initial_indent=label, subsequent_indent=indent)
    return [Text(line) for line in lines]


def _lines_about(decision: Decision, width: int, height: int, signs: Signs) -> list[Text]:
    """A heading and a table of candidates; the last line counts the omitted ones."""
    total = len(decision.candidates)
    lines_left = max(height - 2, 1)
    most = lines_left if total <= lines_left else max(lines_left - 1, 1)
    shown = captions.shortlist(decision, most)
    candidates = [decision.candidates[index] for index in shown]
    numbers = [['r', 'c', 'V', 'status'], *map(captions.numbers_of, candidates)]
    widths = [max(map(len, column)) for column in zip(*numbers, strict=True)]
    room = max(width - sum(widths) - 2 * len(widths) - 2, 4)
    kind = captions.common_kind(decision.candidates)
    regions = (captions.regions_of(one, room, signs, kind) for one in candidates)
    rows = [kind or 'region', *regions]
    widest = max(map(len, rows))
    marks = [' ', *(signs.marker if index == decision.chosen else ' ' for index in shown)]
    lines = [Text(f'{captions.counted(total, "candidate")}: cells r, cost c, value V')]
    for mark, row, (*counts, status) in zip(marks, rows, numbers, strict=True):
        cells = [f'{count:>{size}}' for count, size in zip(counts, widths[:-1], strict=True)]
        style = Style(bold=mark != ' ')
        lines.append(Text('  '.join([f'{mark} {row:<{widest}}', *cells, status]), style))
    lines[1].stylize(Style(italic=True))
    if len(shown) < total:
        lines.append(Text(f'  {total - len(shown):,} more'))
    return lines
