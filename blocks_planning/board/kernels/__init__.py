"""The compiled half of the board. Arguments are trusted: callers have checked them."""
