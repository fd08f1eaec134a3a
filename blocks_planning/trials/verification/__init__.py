"""The checks of a record, one module each.

Each function yields a sentence for everything that contradicts the rest of the record.
:func:`blocks_planning.trials.verify.contradictions` runs all checks.
"""
