"""A page that shows the graph live, and on which a person scopes."""
