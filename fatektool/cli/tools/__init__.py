"""Commands for tests and scripts: simulate, schema, completion."""
