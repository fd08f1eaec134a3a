"""Action-level search: placements that fill a region, and what finding them costs."""
