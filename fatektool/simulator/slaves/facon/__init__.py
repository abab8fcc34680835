"""A simulated PLC that speaks the FACON protocol."""
