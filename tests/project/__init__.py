"""Project files, and the builder of them that shares no code with the reader."""
