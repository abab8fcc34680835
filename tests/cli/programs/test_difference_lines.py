"""What ``verify`` and ``diff`` print of pages that differ: a summary, and the words with ``-v``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool.program.archive import save_backup
from tests.cli.running import served
from tests.program.samples import backup, changed, program

if TYPE_CHECKING:
    from tests.cli.running import Cli

OLD = program(1000)
HINT = "-v shows the words of each page that differs\n"


@pytest.mark.parametrize(
    ("pages", "shown"),
    [
        ((4,), ["differs: 1 word in 1 page (a.json -> b.json)", "page 4"]),
        ((4, 5, 6), ["differs: 3 words in 3 pages (a.json -> b.json)", "pages 4-6"]),
        ((1, 2, 9), ["differs: 3 words in 3 pages (a.json -> b.json)", "pages 1-2, 9"]),
    ],
)
def test_pages_are_named_as_ranges(cli: Cli, place: Path, pages: tuple[int, ...], shown: list[str]) -> None:
    save_backup(backup(OLD), place / "a.json")
    save_backup(backup(changed(OLD, *pages)), place / "b.json")
    done = cli("diff", "a.json", "b.json")
    assert (done.code, done.out.splitlines(), done.err) == (1, shown, HINT)
    assert cli("diff", "a.json", "b.json", "-q").err == ""


@pytest.mark.usefixtures("place")
def test_pages_that_only_one_side_has(cli: Cli) -> None:
    save_backup(backup(program(400)), Path("a.json"))
    save_backup(backup(program(1000)), Path("b.json"))
    first, _, *rest = cli("diff", "a.json", "b.json").out.splitlines()
    assert first == "differs: ladder size 400 words in a.json, 1000 in b.json"
    assert rest[-1] == "pages 8-16: only in b.json"
    assert cli("diff", "b.json", "a.json").out.splitlines()[-1] == "pages 8-16: only in b.json"


@pytest.mark.usefixtures("place")
def test_the_words_in_columns(cli: Cli) -> None:
    save_backup(backup(OLD), Path("a.json"))
    with served(program(1000, seed=2)) as plc:
        done = cli("verify", "a.json", "-v", "-p", plc.target)
        listed = [line for line in done.out.splitlines() if line.startswith("  ")]
        shown = [cell for line in listed for cell in line.strip().replace("   ", "  ").split("  ")]
        document = cli("verify", "a.json", "--json", "-p", plc.target)
    words = [word for page in document.document("verify")["differences"] for word in page["words"]]
    assert [cell.strip() for cell in shown] == [
        f"{word['word']}: {word['a']} -> {word['b']}" for word in words
    ]
    assert max(map(len, listed)) <= 80
    assert HINT not in done.err
    assert document.err == ""
