"""Codes of the end of an attempt, as kernels return them."""

from __future__ import annotations

COMPLETE = 0
"""The region is filled."""
STUCK = 1
"""No legal placement is left, or none was chosen."""
CANCELLED = 2
"""The cancel flag was set."""
OUT_OF_MEMORY = 3
"""The memory is too small: call again with more."""
SOLVED_ALREADY = 4
"""The region is already filled."""
NO_PLACEMENT = 5
"""There is no legal placement."""
NOT_ASKED = 6
"""The problem was not started."""
