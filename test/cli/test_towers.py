"""Commands on towers: list, show, count, exact, watch."""

from __future__ import annotations

import json
from pathlib import Path

from builders import CHAIR
from command import Run, draw_towers


def test_stimuli_lists_the_sets(run: Run) -> None:
    assert run('stimuli') == (0, 'cogsci2021: 16 silhouettes, 8x8 cells\n', '')


def test_stimuli_show_draws_what_can_be_read_again(run: Run, towers: str) -> None:
    done = run('stimuli', 'show', towers, 'cogsci2021/3')
    assert (done.code, done.err) == (0, '')
    Path('again.txt').write_text(done.out)
    assert run('stimuli', 'show', 'again.txt').out.count('#\n') == done.out.count('#\n')
    assert f'# {towers}/chair\n\n' + CHAIR.replace('/', '\n') in done.out
    one = run('stimuli', 'show', 'cogsci2021/3')
    assert one.out.splitlines()[0] == '# cogsci2021/3'
    assert [len(line) for line in one.out.splitlines()[2:]] == [8] * 8


COUNTS = {
    1: [22, 394, 5695],
    2: [31, 833, 19788],
    3: [25, 603, 12523],
    4: [18, 370, 7871],
    5: [17, 278, 4309],
    6: [16, 226, 2936],
    7: [18, 315, 5103],
    8: [22, 414, 6957],
}


def test_count_prints_published_numbers(run: Run) -> None:
    addresses = [f'cogsci2021/{tower}' for tower in COUNTS]
    done = run('count', *addresses, '--depth', 3, '--json')
    assert (done.code, done.err) == (0, '')
    assert [json.loads(line) for line in done.out.splitlines()] == [
        {'stimulus': f'cogsci2021/{tower}', 'counts': counts} for tower, counts in COUNTS.items()
    ]
    assert run('count', 'cogsci2021/2') == (0, 'cogsci2021/2: 31  833  19,788  435,221\n', '')


def test_exact_prints_published_numbers(run: Run) -> None:
    done = run('exact', 'cogsci2021/1', 'cogsci2021/7', '--json')
    assert (done.code, done.err) == (0, '')
    first, second = map(json.loads, done.out.splitlines())
    assert list(first) == [
        *('stimulus', 'fewest_blocks', 'arrangements', 'optimal_arrangements', 'by_rows'),
        'placements',
    ]
    assert first['stimulus'] == 'cogsci2021/1'
    assert (first['fewest_blocks'], first['arrangements']) == (10, 12780)
    assert first['by_rows'] == [4, None, 8, 6, 10, 9, 12, 10]
    assert len(first['placements']) == 10
    assert all(len(placement) == 4 for placement in first['placements'])
    assert second['by_rows'] == [3, 2, None, 5, None, None, None, 12]
    assert run('exact', 'cogsci2021/1').out == (
        'cogsci2021/1: fewest blocks 10; arrangements 12,780, with fewest blocks 1; '
        'by number of rows: 4 - 8 6 10 9 12 10\n'
    )


def test_exact_says_what_is_impossible(run: Run, tmp_path: Path) -> None:
    draw_towers(tmp_path / 'odd.txt', odd='#./##')
    done = run('exact', tmp_path / 'odd.txt', '--json')
    data = json.loads(done.out)
    assert done.code == 0
    assert (data['fewest_blocks'], data['arrangements'], data['placements']) == (None, 0, None)
    assert (
        'impossible; arrangements 0; by number of rows: 1 -'
        in run('exact', tmp_path / 'odd.txt').out
    )


def test_watch_plays_a_trial_and_says_how_it_ended(run: Run, towers: str) -> None:
    done = run('watch', f'{towers}/square', '--pause', 0)
    assert (done.code, done.err) == (0, '')
    assert f'{towers}/square' in done.out
    assert run('watch', f'{towers}/frame', '--pause', 0, '--depth', 2, '--lambda', 0.05).code == 1
