"""Trials: what is run, how it goes on, and what is kept of it."""
