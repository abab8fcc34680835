"""What the simulated PLCs have in common over FACON and over the M-series protocol."""
