"""Human building and marking data, and measures that also apply to planners."""
