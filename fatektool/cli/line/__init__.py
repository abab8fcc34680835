"""Commands for the line: doctor, loopback, scan, ports, link, decode, encode, modbus."""
