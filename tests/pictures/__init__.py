"""The pictures of the documents, made from what the commands print: ``python -m tests.pictures``."""
