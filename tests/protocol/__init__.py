"""Tests of the protocol's bytes: the paper's own examples as literals, and properties over all the rest."""
