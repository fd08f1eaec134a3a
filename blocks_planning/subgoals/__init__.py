"""Subgoal-level planners: which part of the silhouette to build next."""
