"""Reading and writing elements: what a user asks for, in the fewest requests."""
