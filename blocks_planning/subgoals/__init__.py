"""Subgoal planners: they choose the part of the silhouette to build next."""
