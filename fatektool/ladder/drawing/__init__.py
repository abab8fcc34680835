"""A circuit drawn: what stands where, as signs and boxes, and in text. No I/O."""
