"""Views of trials: scenes, the terminal, and picture files."""
