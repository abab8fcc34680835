"""Commands for the PLC itself: status, run, stop."""
