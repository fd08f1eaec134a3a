"""Worlds: what becomes of an order, and what has been observed."""
