"""Media that carry bytes to a PLC: one small class each, all with the same four methods."""
