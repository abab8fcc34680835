"""The listeners of a simulated PLC: TCP, UDP, a pty."""
