"""Towers: cells, blocks, the rules of placement, and silhouette files."""
