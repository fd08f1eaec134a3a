"""Models of the choice of a region: likelihoods, fits, comparison, recovery (docs/fitting.md)."""
