"""The ``link`` command: the PLC's own communication ports and tables."""
