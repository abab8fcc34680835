"""The PLC's own communication ports and tables, read and written."""
