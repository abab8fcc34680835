"""A simulated PLC that speaks the M-series protocol."""
