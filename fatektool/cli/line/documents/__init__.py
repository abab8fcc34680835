"""The JSON documents of the commands for the line."""
