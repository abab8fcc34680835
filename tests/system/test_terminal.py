"""A stream on NUL is no terminal on Windows, although its ``isatty`` is true there."""

from __future__ import annotations

import io
import os
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.cli.shared import streams
from fatektool.cli.shared.questions import can_ask, confirm
from fatektool.errors import UsageError
from fatektool.system import terminal
from tests.platforms import posix

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = posix("the console of Windows is imitated here")


class Device(io.FileIO):
    """NUL, or a console: a device of characters, as the C library reports it."""

    def isatty(self) -> bool:
        return True


@contextmanager
def devices(**consoles: bool) -> Iterator[None]:
    """Have the standard streams on devices, of which some are consoles."""
    null = {name: os.open("/dev/null", os.O_RDWR) for name in consoles}
    is_console = {null[name]: consoles[name] for name in consoles}
    opened = open
    monkeypatch = pytest.MonkeyPatch()

    def as_windows(file: int | str, *words: Any, **options: Any) -> object:
        return Device(file, "w", closefd=False) if file in is_console else opened(file, *words, **options)

    monkeypatch.setattr(streams, "_WINDOWS", True)
    monkeypatch.setattr(streams, "open", as_windows, raising=False)
    monkeypatch.setattr(terminal, "has_console_mode", is_console.__getitem__)
    for name, descriptor in null.items():
        is_read = name == "stdin"
        file = Device(descriptor, "r" if is_read else "w", closefd=False)
        buffer = io.BufferedReader(file) if is_read else io.BufferedWriter(file)
        monkeypatch.setattr(sys, name, io.TextIOWrapper(buffer))
    try:
        streams.mend_streams()
        yield
    finally:
        monkeypatch.undo()
        for descriptor in null.values():
            os.close(descriptor)


def test_consoles_are_terminals() -> None:
    with devices(stdin=True, stdout=True, stderr=True):
        assert can_ask()
        assert sys.stdout.isatty()


def test_nobody_answers_from_nul() -> None:
    for consoles in ({"stdin": False, "stderr": True}, {"stdin": True, "stderr": False}):
        with devices(stdout=True, **consoles):
            assert not can_ask()
            with pytest.raises(UsageError, match="there is no terminal to ask on"):
                confirm("restore?", yes=False)


def test_what_goes_to_nul_is_no_screen() -> None:
    with devices(stdin=True, stdout=False, stderr=True):
        assert not sys.stdout.isatty()
        assert sys.stdout.encoding == "utf-8"
