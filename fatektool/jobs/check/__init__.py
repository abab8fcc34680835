"""The check of a PLC for monitoring: its state, its program, its last backup."""
