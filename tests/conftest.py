"""Property tests: the same cases in each run, unless new ones are looked for.

The default run draws the same cases each time, on every machine, and keeps nothing on disk. ``pytest -m
slow`` runs all property tests too, with four times as many cases, drawn from a new seed, which it prints
first, and again if one fails::

    python -m pytest -m slow                             # a new seed
    python -m pytest -m slow --hypothesis-seed 7 PATH    # the cases of seed 7 again
"""

from __future__ import annotations

import gc
import os
import secrets
import signal
from itertools import count
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import HealthCheck, is_hypothesis_test, settings

from tests.compiling import import_from_the_end, keep_compiled
from tests.in_memory import keep_in_memory
from tests.night import AT_NIGHT, FEW, examples, left_out

if TYPE_CHECKING:
    from pathlib import Path

_SEED = "FATEKTOOL_PROPERTY_SEED"
"""Tells the processes of pytest-xdist the seed."""

# A slow or busy machine is no fault of what is tested.
_ALWAYS: dict[str, Any] = {
    "database": None,
    "deadline": None,
    "print_blob": True,
    "suppress_health_check": [HealthCheck.too_slow],
}
settings.register_profile("same", derandomize=True, max_examples=25, **_ALWAYS)
settings.register_profile("few", derandomize=True, max_examples=examples(25), **_ALWAYS)
settings.register_profile("random", derandomize=False, max_examples=100, **_ALWAYS)


def _looks_for_new_cases(config: pytest.Config) -> bool:
    """True if slow tests are asked for: ``-m slow``, or an expression that has it."""
    words = str(config.option.markexpr).split()
    return any(word == "slow" and words[at - 1 : at] != ["not"] for at, word in enumerate(words))


@pytest.hookimpl(tryfirst=True)  # before Hypothesis reads its seed, and before a test module is imported
def pytest_configure(config: pytest.Config) -> None:
    if not hasattr(config, "workerinput"):
        keep_compiled()
        keep_in_memory()
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # in the background; tests interrupt processes
        signal.signal(signal.SIGINT, signal.default_int_handler)
    random = _looks_for_new_cases(config)
    if random:
        os.environ[AT_NIGHT] = "1"
    settings.load_profile("random" if random else "few" if os.environ.get(FEW) else "same")
    if random and config.option.hypothesis_seed is None:
        config.option.hypothesis_seed = os.environ.setdefault(_SEED, str(secrets.randbelow(1 << 32)))


@pytest.hookimpl(tryfirst=True)
def pytest_collection(session: pytest.Session) -> None:
    import_from_the_end(session.config)


def pytest_collection_finish() -> None:
    """Have what was collected left out of each further search for garbage, which it made ten times longer."""
    gc.collect()
    gc.freeze()


def pytest_report_header(config: pytest.Config) -> str:
    if not _looks_for_new_cases(config):
        return "property tests: the same cases in each run; new ones with -m slow"
    return f"property tests: new cases, from --hypothesis-seed={config.option.hypothesis_seed}"


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if os.environ.get(FEW):
        out = left_out(items)
        config.hook.pytest_deselected(items=out)
        gone = set(map(id, out))
        items[:] = [item for item in items if id(item) not in gone]
    if _looks_for_new_cases(config):
        for item in items:
            function = getattr(item, "obj", None)
            if function is not None and is_hypothesis_test(function):
                item.add_marker("slow")


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    if _looks_for_new_cases(config) and terminalreporter.stats.get("failed"):
        again = f"-m slow --hypothesis-seed={config.option.hypothesis_seed}"
        terminalreporter.write_line(f"The same cases again: python -m pytest {again} PATH::TEST")


_NUMBERS = count()


@pytest.fixture(scope="session")
def states(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("states")


@pytest.fixture(autouse=True)
def state_folder(states: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where restores that did not complete are kept, for each test: made when it is used."""
    folder = states / str(next(_NUMBERS))
    monkeypatch.setenv("FATEKTOOL_STATE_DIR", str(folder))
    return folder
