"""A study with people: what a lab writes down once, a participant's session, what is kept of it."""
