"""How nodes are, as the page shows it."""

from __future__ import annotations

import pytest

from blocks_planning.view.web.health import (
    MOST_CHARACTERS,
    MOST_NODES,
    MOST_VALUES,
    NOTHING,
    SILENT_S,
    health_after,
    health_json,
)


def test_the_last_word_of_each_node_is_kept_in_order_of_names() -> None:
    health = health_after(NOTHING, 'world', 0, 'building', [('load', '0.1')], 1.0)
    health = health_after(health, 'searcher', 1, 'slow', [], 1.0)
    health = health_after(health, 'world', 2, 'no journal', [('load', '0.9')], 2.0)
    shown = health_json(health, 2.0, hides_costs=False)
    assert [(one['name'], one['level'], one['message']) for one in shown] == [
        ('searcher', 'warning', 'slow'),
        ('world', 'error', 'no journal'),
    ]
    assert shown[1]['values'] == [['load', '0.9']]
    assert NOTHING == {}


@pytest.mark.parametrize(('level', 'word'), [(0, 'ok'), (3, 'stale'), (4, 'stale'), (-1, 'stale')])
def test_levels_are_words(level: int, word: str) -> None:
    health = health_after(NOTHING, 'world', level, '', [], 0.0)
    assert health_json(health, 0.0, hides_costs=False)[0]['level'] == word


def test_a_node_that_says_nothing_is_silent() -> None:
    health = health_after(NOTHING, 'world', 0, '', [], 10.0)
    assert health_json(health, 10.0 + SILENT_S, hides_costs=False)[0]['level'] == 'ok'
    late = health_json(health, 20.0, hides_costs=False)[0]
    assert (late['level'], late['age']) == ('silent', 10)


def test_everything_is_bounded() -> None:
    health = NOTHING
    for number in range(MOST_NODES + 5):
        values = [(f'{key}' * 300, 'v' * 300) for key in range(MOST_VALUES + 5)]
        health = health_after(health, f'n{number}' + 'x' * 300, 0, 'm' * 300, values, 0.0)
    assert len(health) == MOST_NODES
    for node in health.values():
        assert len(node.values) == MOST_VALUES
        texts = [node.name, node.message, *node.values, *node.values.values()]
        assert max(map(len, texts)) == MOST_CHARACTERS


def test_hidden_costs_leave_names_and_levels() -> None:
    health = health_after(NOTHING, 'searcher', 0, '7 states', [('states evaluated', '7')], 0.0)
    (shown,) = health_json(health, 0.0, hides_costs=True)
    assert shown == {'name': 'searcher', 'level': 'ok', 'message': '', 'values': [], 'age': 0}
