"""Where clients reach a simulated PLC: TCP, UDP, a pty."""
