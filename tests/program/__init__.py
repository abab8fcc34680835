"""Tests of the program as a value: image, comparison, backup file."""
