"""How an attempt ends, as the numbers that kernels return."""

from __future__ import annotations

COMPLETE = 0
"""The region is filled."""
STUCK = 1
"""Nothing legal is left, or nothing was chosen."""
CANCELLED = 2
"""The cancel flag was up."""
OUT_OF_MEMORY = 3
"""The memory that was handed over is too small: hand over more and ask again."""
SOLVED_ALREADY = 4
"""The region is filled before anything is placed."""
NO_PLACEMENT = 5
"""Nothing legal can be placed at all."""
NOT_ASKED = 6
"""The problem was not taken up."""
