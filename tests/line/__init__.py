"""Loopback test, diagnosis, scan and doctor."""
