"""Tests of the simulated PLC. Frames are built here or stand as literal bytes, never by its own code."""
