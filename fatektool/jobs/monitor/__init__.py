"""A program's networks beside what the PLC has now: what carries, and why an element is on or off."""
