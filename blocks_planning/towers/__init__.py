"""Making towers with wanted properties, and sets of them that are alike on average.

``ranges`` says what is wanted, ``candidates`` builds towers at random, ``measures`` and
``difficulty`` measure them, ``making`` keeps those that are as wanted, ``balancing`` divides them,
and ``writing`` writes them down.
"""
