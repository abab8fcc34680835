"""A simulated PLC over the M-series protocol."""
