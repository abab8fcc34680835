"""Serial ports: opening, settings, errors."""
