"""One target under atheris: its code is instrumented when imported, so that the fuzzer sees where it goes.

Usage: python -m fuzz.under_atheris TARGET [libFuzzer's options and folders]
"""

from __future__ import annotations

import importlib
import sys
from typing import Any


def main() -> None:
    """Fuzz until libFuzzer ends the process."""
    atheris: Any = importlib.import_module("atheris")
    name = sys.argv.pop(1)
    with atheris.instrument_imports(include=["fatektool", "json", "tomllib"]):
        target = importlib.import_module(f"fuzz.{name}")
    atheris.Setup(sys.argv, target.one_input)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
