"""Modbus: the client, on pymodbus' PDUs, and the simulated slave, without them, each from the papers."""
