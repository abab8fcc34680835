"""The ``monitor`` command."""
