"""Modbus in its three framings, as a protocol for these PLCs."""
