"""Commands for programs: backup, verify, restore, inspect, listing, xref, diff."""
