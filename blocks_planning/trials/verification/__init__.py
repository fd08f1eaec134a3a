"""The questions that verification asks of a record, one module each.

Each function yields a sentence for everything that does not follow from the rest of the record.
:func:`blocks_planning.trials.verify.contradictions` asks them all.
"""
