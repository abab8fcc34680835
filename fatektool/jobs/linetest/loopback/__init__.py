"""The loopback test: its data, its exchanges, its result."""
