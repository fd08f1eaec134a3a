"""Sweeps of many trials: what to run, running it anywhere, and the tables it leaves."""
