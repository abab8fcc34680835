"""The fuzzers' kept corpus, without a fuzzer: every promise held for every input of it, everywhere."""

from __future__ import annotations

import importlib
from pathlib import Path
from random import Random

import pytest

import fuzz

CORPUS = Path(fuzz.__file__).parent / "corpus"
TARGETS = sorted(folder.name for folder in CORPUS.iterdir())
SPOILED = 40


@pytest.mark.parametrize("target", TARGETS)
def test_every_input_of_the_corpus(target: str) -> None:
    one_input = importlib.import_module(f"fuzz.{target}").one_input
    inputs = sorted((CORPUS / target).iterdir())
    assert inputs
    for path in inputs:
        one_input(path.read_bytes())
    one_input(b"")


@pytest.mark.parametrize("target", TARGETS)
def test_inputs_near_those_of_the_corpus(target: str) -> None:
    """Cut, doubled, a byte changed: what a fuzzer begins with."""
    one_input = importlib.import_module(f"fuzz.{target}").one_input
    random = Random(1)  # noqa: S311  # the same inputs each time
    inputs = [path.read_bytes() for path in sorted((CORPUS / target).iterdir())]
    for _ in range(SPOILED):
        data = bytearray(random.choice(inputs))
        for _ in range(random.randint(1, 4)):
            at = random.randrange(len(data) + 1)
            data[at : at + random.choice((0, 1, 1, 8))] = random.randbytes(random.choice((0, 1, 1, 4)))
        one_input(bytes(data))


def test_every_target_has_a_corpus() -> None:
    modules = {path.stem for path in CORPUS.parent.glob("*.py") if "def one_input" in path.read_text()}
    assert modules == set(TARGETS)
