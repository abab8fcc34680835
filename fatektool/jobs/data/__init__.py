"""The data of a PLC beside its program: read for a backup, compared, written back."""
