"""The M-series protocol: binary frames with a CRC."""
