"""A plan in characters, for a terminal or a file."""
