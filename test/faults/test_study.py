"""A study goes on after everything that can happen to its server, its page and its disk."""

from __future__ import annotations

from pathlib import Path

import pytest

from faults.study import KINDS, run_study


@pytest.mark.long
def test_nothing_is_lost_whatever_happens(tmp_path: Path) -> None:
    plan = dict(zip((4, 8, 9, 13), KINDS, strict=True))
    assert run_study(tmp_path, [plan]) == []
