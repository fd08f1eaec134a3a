"""What all tests share."""

import os

from hypothesis import HealthCheck, settings

# A process that goes down beside a compiler may need more than the usual second.
os.environ.setdefault('BLOCKS_PLANNING_EXIT_BOUND_S', '10')

# The same examples in every run and every process; compiling a kernel takes its time.
settings.register_profile(
    'blocks_planning',
    derandomize=True,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile('blocks_planning')
