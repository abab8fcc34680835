"""A simulated PLC as a Modbus slave."""
