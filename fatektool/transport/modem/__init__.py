"""A modem between this computer and the PLC: the call, its commands, its results."""
