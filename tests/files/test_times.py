"""Times: UTC in files, local on a screen."""

from __future__ import annotations

import sys
import time
from io import StringIO
from typing import TYPE_CHECKING

import pytest

from fatektool.cli.shared.output import shown_time
from fatektool.files.times import local

if TYPE_CHECKING:
    from collections.abc import Iterator

NIGHT = "2026-11-22T03:15:00Z"


class Screen(StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture
def zone(monkeypatch: pytest.MonkeyPatch) -> Iterator[pytest.MonkeyPatch]:
    yield monkeypatch
    monkeypatch.undo()
    if hasattr(time, "tzset"):
        time.tzset()


@pytest.mark.skipif(sys.platform == "win32", reason="a process has no time zone of its own there")
@pytest.mark.parametrize(
    ("name", "shown"),
    [("<+01>-1", "2026-11-22 04:15:00 +0100"), ("<-0330>3:30", "2026-11-21 23:45:00 -0330"), ("UTC", NIGHT)],
)
def test_a_screen_has_the_time_of_its_clock(zone: pytest.MonkeyPatch, name: str, shown: str) -> None:
    zone.setenv("TZ", name)
    time.tzset()
    assert local(NIGHT) == shown
    assert shown_time(NIGHT, Screen()) == shown
    assert shown_time(NIGHT, StringIO()) == NIGHT


@pytest.mark.parametrize("text", ["", "yesterday", "2026-11-22T03:15:00.5Z"])
def test_what_is_no_such_time_stays_as_it_is(text: str) -> None:
    assert local(text) == text
