"""The one write that can be undone: of a program, and of values."""
