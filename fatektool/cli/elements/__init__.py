"""Commands for elements: read, write, snapshot, watch, discrete."""
