"""Comparison of every claim of the paper with our number: verdicts and reasons of differences."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from blocks_planning.analysis.bootstrap import Estimate
from blocks_planning.analysis.explanations import COUNTINGS
from blocks_planning.analysis.formats import format_number, with_interval
from blocks_planning.analysis.paper import Claim, Reported
from blocks_planning.analysis.paper_file import the_paper
from blocks_planning.analysis.verdicts import Verdict, judge
from blocks_planning.extras import extra

with extra('experiments'):
    import pandas as pd

NONE_KNOWN = 'None known.'


def compare(presets: Mapping[str, Any], trials: pd.DataFrame) -> dict[str, list[dict[str, Any]]]:
    """Every claim of the paper in every preset, for ``results.json``.

    Args:
        presets: the results of each preset; see :func:`.results.summarise`.
        trials: the table from which they were computed.

    Returns:
        A list for each preset. A claim without a number in the results (a quick run omits some)
        is omitted.
    """
    return {preset: _compare(preset, presets, trials) for preset in presets}


def _compare(
    preset: str, presets: Mapping[str, Any], trials: pd.DataFrame
) -> list[dict[str, Any]]:
    compared = []
    for claim in the_paper().claims:
        ours = find(presets[preset], claim.path)
        if ours is None:
            continue
        verdict = judge(claim.is_effect, claim.judged, ours)
        compared.append(
            {
                'id': claim.id,
                'statement': claim.statement,
                'is_effect': claim.is_effect,
                'paper': _json_or_none(claim.printed),
                'analysis': _json_or_none(claim.analysis),
                'ours': ours,
                'against': claim.judged.kind.value,
                'verdict': verdict.to_json(),
                'analysis_verdict': _against_the_analysis(claim, ours),
                'contradiction': claim.contradiction,
                'why': '' if verdict.agrees else _why(claim, preset, presets, trials),
            }
        )
    return compared


def find(results: Any, path: tuple[object, ...]) -> Any:
    """The number at a path; a mapping in it selects the first such item of a list."""
    for step in path:
        if isinstance(step, Mapping):
            results = next((item for item in results if step.items() <= item.items()), None)
        elif results is not None:
            results = results.get(step)
    return results


def _json_or_none(reported: Reported | None) -> dict[str, Any] | None:
    return None if reported is None else reported.to_json()


def _against_the_analysis(claim: Claim, ours: Mapping[str, Any]) -> dict[str, Any] | None:
    """The verdict on the analysis' number, where the paper prints another one."""
    if claim.printed is None or claim.analysis is None:
        return None
    return judge(claim.is_effect, claim.analysis, ours).to_json()


def _why(claim: Claim, preset: str, presets: Mapping[str, Any], trials: pd.DataFrame) -> str:
    """A measured reason, or that none is known and what was tried."""
    ours = find(presets[preset], claim.path)
    if ours['mean'] is None:
        return 'Ours is the same at every lambda, so r is undefined.'
    tried = []
    for counting in COUNTINGS:
        if not counting.applies(claim):
            continue
        found = counting.measure(trials, preset, claim)
        told = f'counted with {counting.words}, ours is {_shown(found)}'
        if _judge(claim, found).agrees:
            return f'Measured: {told}, which agrees.'
        tried.append(told)
    for other, results in presets.items():
        theirs = find(results, claim.path)
        if other != preset and theirs and judge(claim.is_effect, claim.judged, theirs).agrees:
            shown = with_interval(theirs)
            return f'Measured: it is the settings; those of preset {other} give {shown}, which agrees.'
    return f'{NONE_KNOWN} ' + ''.join(f'Not explained: {told}. ' for told in tried).strip()


def _judge(claim: Claim, found: Estimate) -> Verdict:
    return judge(claim.is_effect, claim.judged, found.to_json())


def _shown(found: Estimate) -> str:
    as_json = found.to_json()
    return 'undefined' if as_json['mean'] is None else with_interval(as_json)


def count_verdicts(claims: list[dict[str, Any]]) -> dict[str, int]:
    """How many effects are the same and differ, how many sizes overlap and differ."""
    effects = [claim['verdict']['effect'] for claim in claims if claim['is_effect']]
    sizes = [claim['verdict']['size'] for claim in claims]
    return {
        'effects': len(effects),
        'effects_same': effects.count('same'),
        'sizes': len(sizes),
        'sizes_overlap': sizes.count('overlap'),
    }


def ratio_text(verdict: Mapping[str, Any]) -> str:
    """The answer on size in words: 'overlap', or the ratio of ours to the paper's."""
    if verdict['size'] == 'overlap':
        return 'overlap'
    if verdict['ratio'] is None:
        return 'differs'
    if verdict['ratio'] <= 0:
        return 'other sign'
    return f'x {format_number(verdict["ratio"])}'
