"""What people built and marked, and measures of it that apply to planners too."""
