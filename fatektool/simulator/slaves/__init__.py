"""The protocols that a simulated PLC speaks. No code is shared with the client."""
