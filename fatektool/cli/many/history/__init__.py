"""The ``history`` command."""
