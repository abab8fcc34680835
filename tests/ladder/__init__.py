"""Words, instructions and networks."""
