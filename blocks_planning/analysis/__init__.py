"""From tables of trials to statistics, figures and a report."""
