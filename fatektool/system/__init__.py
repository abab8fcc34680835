"""What differs between operating systems: shells, and processes that end together."""
