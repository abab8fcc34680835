"""Circuits drawn: where the parts stand, and in text."""
