"""Worlds: the outcomes of orders, and observations of the board."""
