"""The errors that this package raises on purpose.

::

    BlocksPlanningError
    ├── InvalidInput            an input is wrong: exit code 2
    │   ├── StimulusError       a silhouette, or the file that contains it
    │   ├── ConfigurationError  a planner, search or library setting
    │   └── RecordError         a trial record, or the file that contains it
    └── LimitExceeded           the problem is valid but exceeds a stated limit: exit code 3

Every message is one sentence on one line that names the value and its source, and says what is
expected. Any other exception is a defect.
"""

from __future__ import annotations


class BlocksPlanningError(Exception):
    """Base of every error that is raised on purpose."""


class InvalidInput(BlocksPlanningError, ValueError):
    """A value from outside that can't be used."""


class StimulusError(InvalidInput):
    """A silhouette that can't be read, or is not a silhouette."""


class ConfigurationError(InvalidInput):
    """A planner, search, block library or trial setting out of its range."""


class RecordError(InvalidInput):
    """A trial record that can't be read, or contradicts itself."""


class LimitExceeded(BlocksPlanningError):
    """A computation that would exceed its stated limit; it has no result."""


def shown(value: object, most: int = 60) -> str:
    """A value as an error message shows it: on one line, and cut to ``most`` characters."""
    try:
        text = repr(value)
    except (ValueError, RecursionError):  # thousands of digits or nested levels
        return 'a value that is too long to show'
    return text if len(text) <= most else f'{text[: most - 3]}...'
