"""The header of a program image: which family of PLC made it, in which byte order, and whether it holds."""
