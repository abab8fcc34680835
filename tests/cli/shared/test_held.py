"""Lines for stderr while a screen is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.cli.shared.output import Held, print_stderr

if TYPE_CHECKING:
    import pytest


def test_a_line_is_shown_until_it_was_read_and_a_later_round_came(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    now = [0.0]
    woken: list[None] = []
    monkeypatch.setattr("time.perf_counter", lambda: now[0])
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    first, later = object(), object()
    with Held() as held:
        held.on_news = lambda: woken.append(None)
        assert held.over("typed", first) == "typed"
        for _ in range(2):
            print_stderr("in use")
        assert len(woken) == 2
        assert held.over("typed", first) == "in use"
        now[0] = 100.0
        assert held.over("in use", first) == "in use"
        assert held.over("in use", later) == ""
        assert held.over("typed", later) == "typed"
        print_stderr("late")
        assert held.over("", later) == "late"
        assert held.over("late", object()) == "late"  # nobody could have read it
        now[0] = 104.0
        assert held.over("late", object()) == ""
        assert capsys.readouterr().err == ""
    assert capsys.readouterr().err == "in use\nlate\n"


def test_what_goes_elsewhere_goes_there_at_once(capsys: pytest.CaptureFixture[str]) -> None:
    with Held() as held:
        print_stderr("to a file")
        assert capsys.readouterr().err == "to a file\n"
        assert held.over("", None) == ""
    assert capsys.readouterr().err == ""
