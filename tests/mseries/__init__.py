"""The M-series client and the simulated M-series PLC, each built from the paper, together."""
