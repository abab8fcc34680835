"""The inventory: the file that names the PLCs."""
