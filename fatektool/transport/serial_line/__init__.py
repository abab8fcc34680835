"""Serial ports: opening, settings, errors in the project's words."""
