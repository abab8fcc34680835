"""The PLC's own communication ports: CLINK and M-BUS tables, results, settings. No I/O."""
