"""The promises of docs/reliability.md, each proven."""
