"""What is done with bytes from outside: a target a kind, a function of bytes that raises if a promise breaks.

A target's ``one_input`` knows nothing of the fuzzer. ``run.py`` lets atheris look for bytes that break it,
from the kept corpus in ``corpus/TARGET/``; the tests go through that corpus without a fuzzer.
"""
