"""Trials: their specification, their execution and their records."""
