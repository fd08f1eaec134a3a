"""Behaviour of people and planners under the same measures: tables, figures, and a section."""
