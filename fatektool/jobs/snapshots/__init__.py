"""Snapshots: a PLC's data at one time, as files, compared and written back."""
