"""The ``inventory`` command."""
