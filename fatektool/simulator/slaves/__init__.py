"""The protocols of a simulated PLC. No code is shared with the client."""
