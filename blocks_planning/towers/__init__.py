"""Generation of towers with wanted properties, and of sets of towers that are similar on average.

``ranges`` describes wanted values, ``candidates`` builds towers at random, ``measures`` and
``difficulty`` measure them, ``making`` keeps those within the ranges, ``balancing`` divides them
into sets, and ``writing`` writes them to files.
"""
