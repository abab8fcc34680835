"""The ``link table`` command."""
