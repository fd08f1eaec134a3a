"""Speed programs: ``python -m benchmarks``. They print ratios taken in one run, and write JSON."""
