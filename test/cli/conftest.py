"""No lines on progress, which would depend on how busy the machine is."""

from __future__ import annotations

from math import inf

import pytest

from blocks_planning.cli import progress


@pytest.fixture(autouse=True)
def _no_lines_on_progress(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    if request.path.name != 'test_progress.py':
        monkeypatch.setattr(progress, 'FIRST_LINE_S', inf)
