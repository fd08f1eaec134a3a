"""Holding our numbers against the paper's.

* ``within the paper's interval``: our estimate lies in the paper's 95 % confidence interval.
* ``same direction``: it does not, or the paper gives no interval, but it says the same: an effect
  has the same sign and our interval leaves out 0; what the paper can't tell from 0 we can't
  either; a level is within a factor of two, or the paper's number lies in our interval.
* ``does not hold``: neither.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from blocks_planning.analysis.paper import Claim, Kind, claims

WITHIN = "within the paper's interval"
SAME = 'same direction'
FAILS = 'does not hold'

_FACTOR = 2.0

_ONE_SOLVE = (
    'The published tables rest on few precomputed solves per subgoal (10 for BFS), with random '
    'ties re-seeded identically before each choice, so several of its intervals are too narrow.'
)
_QUEUE = (
    'The published A* used a priority queue that did not keep its order, so it was less greedy '
    'and searched longer.'
)
_GREEDY = (
    'With the smallest block area as divisor, f never rises along a path: A* dives to a complete '
    'state at little cost, where the published program used the mean area.'
)
_CEILING = 'A* solves every tower at every lambda here, so there is nothing to correlate.'
_DEAD_ENDS = 'The published random agent avoided immediate dead ends; the paper describes none.'
_CHEAP = 'A* finds its way at fewer states here, so lambda weighs less and changes less.'
_LESS_LINEAR = (
    'Most of the change lies at the smallest values of lambda, and one drawn run per silhouette '
    'adds noise, so that r is less extreme.'
)


def judge(claim: Claim, ours: Mapping[str, Any]) -> str:
    """The verdict on a claim; ``ours`` is ``{"mean": ..., "ci": [low, high]}``."""
    mean, (low, high) = ours['mean'], ours['ci']
    if mean is None:
        return FAILS
    if claim.interval and claim.interval[0] <= mean <= claim.interval[1]:
        return WITHIN
    leaves_out_0 = low > 0 or high < 0
    if claim.kind is Kind.NO_EFFECT:
        return FAILS if leaves_out_0 else SAME
    if claim.kind is Kind.EFFECT:
        return SAME if leaves_out_0 and mean * claim.value > 0 else FAILS
    near = claim.value / _FACTOR <= mean <= claim.value * _FACTOR
    return SAME if near or low <= claim.value <= high else FAILS


def compare(results: Mapping[str, Any], preset: str) -> list[dict[str, Any]]:
    """Every claim of the paper with our number and the verdict, for ``results.json``.

    A claim whose number the results don't have (a quick run leaves some out) is left out.
    """
    compared = []
    for claim in claims():
        ours = _find(results, claim.path)
        if ours is None:
            continue
        verdict = judge(claim, ours)
        compared.append(
            {
                'id': claim.id,
                'statement': claim.statement,
                'paper': {'mean': claim.value, 'ci': claim.interval and list(claim.interval)},
                'ours': ours,
                'verdict': verdict,
                'why': '' if verdict == WITHIN else _why(claim, preset, ours),
            }
        )
    return compared


def _find(results: Any, path: tuple[object, ...]) -> Any:
    """The number at a path; a mapping in it selects the first such item of a list."""
    for step in path:
        if isinstance(step, Mapping):
            results = next(
                (item for item in results if step.items() <= item.items()),
                None,
            )
        elif results is not None:
            results = results.get(step)
    return results


def _why(claim: Claim, preset: str, ours: Mapping[str, Any]) -> str:
    """A sentence on why a number differs, where that is known."""
    astar = 'astar' in claim.id
    if claim.id.startswith('table1.random'):
        return _DEAD_ENDS
    if 'r-lambda' in claim.id:
        return _why_correlation(claim, astar, ours)
    if astar:
        return _GREEDY if preset == 'text' else _QUEUE
    return '' if claim.id.endswith('success') else _ONE_SOLVE


def _why_correlation(claim: Claim, astar: bool, ours: Mapping[str, Any]) -> str:
    if ours['mean'] is None:
        return _CEILING
    if astar:
        return _CHEAP
    return '' if claim.id.endswith('blocks') else _LESS_LINEAR
