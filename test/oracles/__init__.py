"""Slow, plain twins of the planning core, to hold the fast code against.

Everything here works on plain sets of (column, row) cells and follows the definitions word by
word: trees are built node by node, nothing is cached unless a docstring says so, nothing is
imported from the package under test. Only the standard library is used.

* ``randomness``: the generator every draw comes from
* ``board``: how blocks fall, which placements are possible and legal
* ``tree``: what every search explores; ``breadth_first``, ``best_first``, ``beam`` and
  ``monte_carlo``: the searches; ``search``: one attempt with any of them
* ``slipping``: success where blocks slip, of the best orders, bfs and random
* ``statics``: whether loose blocks stand
* ``exact``: fewest blocks and number of complete arrangements, in two independent ways
* ``lookahead``: sequences of subgoals, and choice by probability
* ``solving``: attempts at a region within a budget
* ``decisions``: candidates, decisions, trials; ``planners``: none, scoping, full
"""
