"""Reading, comparing and restoring ladder programs."""
