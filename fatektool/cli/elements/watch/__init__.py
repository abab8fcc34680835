"""The ``watch`` command."""
