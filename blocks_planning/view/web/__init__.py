"""A page that shows the trials live, and on which a person can plan."""
