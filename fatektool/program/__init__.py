"""The ladder program as a value: its pages, its header, its backup file, its differences."""
