"""A simulated PLC over the FACON protocol."""
