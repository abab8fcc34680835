"""Tests of the line: loopback, scan, doctor, and the diagnosis of what they measure."""
