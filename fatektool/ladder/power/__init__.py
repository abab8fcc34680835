"""What conducts in a circuit, as far as the states of its elements are known. No I/O."""
