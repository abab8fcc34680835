"""A modem between this computer and the PLC: its commands and results, the call."""
