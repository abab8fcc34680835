"""Tests of backup, verify and restore over a line in the same process."""
