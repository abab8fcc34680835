"""Commands for many PLCs: fleet, inventory, history, check."""
