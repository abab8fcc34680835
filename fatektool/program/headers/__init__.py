"""The header of a program image: the PLC family, the byte order, and whether it is valid."""
