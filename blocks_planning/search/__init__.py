"""Action-level search: finds placements that fill a region, and counts the cost."""
