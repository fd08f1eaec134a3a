"""Visual scoping of block towers: boards, searches, subgoal planners and trials.

The package reproduces the planners of Binder, Mattar, Kirsh and Fan (2021), *Visual scoping
operations for physical assembly*. Nothing is imported here, so that ``import blocks_planning``
is instant; the layers are, from the ground up::

    errors  <-  board  <-  search  <-  subgoals  <-  trials  <-  view  <-  cli
"""

__version__ = '0.1.0'
