"""A network as a circuit: series, parallels, outputs and boxes. No I/O."""
