"""Tests of the command line: in this process where that is enough, else as its users run it."""
