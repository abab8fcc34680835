"""Real programs of others beside the tool: gateways, Modbus clients, monitoring."""
