"""Looking at trials: scenes, the terminal, and pictures in files."""
