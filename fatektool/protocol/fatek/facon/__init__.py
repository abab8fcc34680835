"""The FACON protocol: ASCII frames with an LRC."""
