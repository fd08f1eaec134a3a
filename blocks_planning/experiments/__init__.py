"""Sweeps of many trials: their specification, their execution, and their tables."""
