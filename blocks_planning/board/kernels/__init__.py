"""Compiled functions of the board. Arguments are not checked here: callers have checked them."""
