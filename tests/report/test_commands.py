"""``--report`` of each command: the file, its figures, and what is done where it cannot be written."""

from __future__ import annotations

import json
import re
import shutil
import signal
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.report.networks import MOST_DRAWN
from fatektool.report.program import MOST_PAGES
from fatektool.report.rounds import MOST_GAPS, MOST_POINTS
from fatektool.report.series import MOST_CHARTS, MOST_DISCRETES
from fatektool.report.snapshot import MOST_ROWS
from tests.cli.running import NEW, OLD, Cli, Done, Press, check, one_line, process, started
from tests.plant import cut_after, spied
from tests.project.files import IMAGE, project_file
from tests.report.tree import Node, facts, parse, rows, texts
from tests.root import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.program.image import Program


def report_of(folder: Path, name: str = "x.html") -> Node:
    html = (folder / name).read_text(encoding="utf-8")
    assert not list(folder.glob(".fatektool*"))
    return parse(html)


def documents(done: Done) -> list[Any]:
    return [json.loads(line) for line in done.out.splitlines()]


def marked(page: Node) -> list[str]:
    return [each.text for each in page.every("mark")]


def words_that_differ(a: Program, b: Program) -> list[str]:
    """As the report has them, page by page: first all of one side, then all of the other."""
    found = []
    for one, other in zip(a.pages, b.pages, strict=True):
        pairs = [(one[place : place + 2], other[place : place + 2]) for place in range(0, 128, 2)]
        different = [pair for pair in pairs if pair[0] != pair[1]]
        found += [pair[side].hex().upper() for side in (0, 1) for pair in different]
    return found


@pytest.mark.parametrize("command", ["verify", "diff"])
def test_programs(press: Press, cli: Cli, command: str) -> None:
    words = ["verify", press.new] if command == "verify" else ["diff", press.new, press.old]
    plain = cli(*words)
    done = cli(*words, "--report", "x.html", "--force")
    assert done == plain  # the answer is what it is without a report
    assert done.code == 1
    page = report_of(press.folder)
    document = cli(*words, "--json", "--report", "y.html").document(command)
    assert facts(page)["Words that differ"].figures == [document["words_differ"]]
    assert facts(page)["Pages that differ"].figures == [document["pages_differ"]]
    assert marked(page) == words_that_differ(NEW, OLD)
    assert cli("diff", press.old, press.old, "--report", "x.html", "--force").code == 0
    assert marked(report_of(press.folder)) == []


def test_loopback(press: Press, cli: Cli) -> None:
    done = cli("loopback", "--count", "24", "--json", "--report", "x.html", "--force")
    document = json.loads(done.out)
    page = report_of(press.folder)
    assert facts(page)["Sent"].figures == [document["sent"]] == [24]
    assert facts(page)["Bytes sent"].figures == [document["bytes_sent"]]
    found = [[figure for cell in row for figure in cell.figures] for row in rows(page, "Loopbacks by time")]
    assert found == [[each["from_ms"], each["to_ms"], each["count"]] for each in document["histogram"]]
    sizes = [row[0].figures[0] for row in rows(page, "By size of the data sent")]
    assert sizes == [each["size"] for each in document["by_size"]]


def test_watch(press: Press, cli: Cli) -> None:
    words = ["watch", "R0", "Y0", "R9000", "--count", "5", "--interval", "0", "--report", "x.html", "--force"]
    done = cli(*words)
    assert done.code == 4
    found = documents(done)
    for each in found:
        check(each, "watch")
    page = report_of(press.folder)
    overview = {row[0].text: row for row in rows(page, "All values, all rounds")}
    assert {key: row[3].figures[0] for key, row in overview.items()} == found[-1]["values"]
    assert {key: row[9].figures[0] for key, row in overview.items()} == {"R0": 0, "Y0": 0, "R9000": 5}
    (gap,) = texts(page, "Missing values")
    assert gap[2:4] == ["R9000", "5"]
    assert gap[4] == " ".join(found[0]["errors"]["R9000"].split())


def test_watch_that_is_interrupted(press: Press) -> None:
    job = started(
        "watch", "R0", "--interval", "0.01", "-p", press.target, "--report", "x.html", "--force", "--json"
    )
    assert job.stdout is not None
    lines = [job.stdout.readline() for _ in range(3)]
    job.send_signal(signal.SIGINT)
    out, err = job.communicate()
    assert (job.returncode, err) == (130, "fatektool: interrupted\n")
    found = [json.loads(line) for line in (*lines, *out.splitlines())]
    assert found[-1]["schema"] == "fatektool.error/1"
    page = report_of(press.folder)
    assert "Ended: interrupted." in page.first("header").text
    # The round of the interrupt may be in the report and not on stdout any more.
    assert facts(page)["Rounds read"].figures[0] - (len(found) - 1) in {0, 1}


def test_watch_whose_reader_has_seen_enough(press: Press) -> None:
    words = ["watch", "R0", "--interval", "0.01", "-p", press.target, "--report", "x.html", "--force"]
    process(*words, redirect="| head -n 2")
    assert facts(report_of(press.folder))["Rounds read"].figures[0] >= 2


def test_watch_over_a_line_that_dies(press: Press, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("time.sleep", lambda _: None)
    cut_after(monkeypatch, 12)
    done = cli("watch", "R0", "--retries", "0", "--timeout", "0.05", "--report", "x.html", "--force")
    assert done.code == 3
    page = report_of(press.folder)
    assert "no answer" in page.first("header").text
    assert facts(page)["Rounds read"].figures == [len(documents(done))]
    assert facts(page)["Rounds lost"].figures == [10]
    lost = [row[2:4] for row in texts(page, "Missing values")]
    assert {name for name, _ in lost} == {"all"}
    assert sum(int(count) for _, count in lost) == 10


def test_watch_over_a_line_that_comes_back(press: Press, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("time.sleep", lambda _: None)
    seen: list[bytes] = []
    spied(monkeypatch, seen.append, lambda: not 8 < len(seen) < 16)
    words = ["--count", "6", "--retries", "0", "--timeout", "0.05", "--report", "x.html", "--force"]
    done = cli("watch", "R0", *words)
    assert done.code == 0
    page = report_of(press.folder)
    assert facts(page)["Rounds read"].figures == [6]
    assert facts(page)["Rounds lost"].figures == [done.err.count("trying again")]
    assert "Read with gaps" in page.first("header").text


def test_a_report_that_cannot_be_written_in_the_end(
    press: Press, cli: Cli, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The failure of the line is what counts; that there is no report is a warning."""
    monkeypatch.setattr("time.sleep", lambda _: None)
    folder = press.folder / "gone"
    folder.mkdir()
    calls = []

    def passes() -> bool:
        calls.append(0)
        if len(calls) == 12:
            folder.rmdir()
        return len(calls) < 12

    spied(monkeypatch, lambda _: None, passes)
    done = cli("watch", "R0", "--retries", "0", "--timeout", "0.05", "--report", "gone/x.html")
    assert done.code == 3
    *_, warning, last = done.err.splitlines()
    assert "gone is not a folder" in warning
    assert warning.startswith("warning: ")
    assert last.startswith("fatektool: no answer")


# --- snapshots ------------------------------------------------------------------------------------------


def test_one_snapshot(press: Press, cli: Cli) -> None:
    cli("write", "R5=7", "D4:f32=1.5", "Y1=on")
    done = cli("snapshot", "R5", "D4:f32", "Y0-Y1", "R9:hex", "--report", "x.html", "--force")
    assert done.code == 0
    document = done.document("snapshot")
    found = rows(report_of(press.folder), "Values in the PLC")
    assert {row[0].text: row[3].figures[0] for row in found} == document["values"]


@pytest.mark.parametrize("where", ["--append", "-o"])
def test_a_series_of_snapshots(press: Press, cli: Cli, where: str) -> None:
    (press.folder / "press").mkdir()
    target = "press.ndjson" if where == "--append" else "press/"
    for value in (4, 9, 2):
        cli("write", f"R5={value}")
        assert cli("snapshot", "R5", where, target, "--report", "x.html", "--force").code == 0
    (row,) = rows(report_of(press.folder), "All values, all rounds")
    last, least, mean, most, changes, read, gaps = (cell.figures[0] for cell in row[3:])
    assert (last, least, mean, most, changes, read, gaps) == (2, 2, 5.0, 9, 2, 3, 0)


def test_what_is_left_out_of_a_series_is_said(press: Press, cli: Cli) -> None:
    line = cli("snapshot", "R5", "--format", "ndjson").out
    foreign = line.replace('"station":1', '"station":2')
    old, no_day = (re.sub(r"20\d\d-\d\d-\d\d", day, line) for day in ("0001-01-01", "2026-04-31"))
    (press.folder / "s.ndjson").write_text(line + foreign + line[:60] + "\n" + foreign + old + no_day)
    assert cli("snapshot", "R5", "--append", "s.ndjson", "--report", "x.html", "--force").code == 0
    page = report_of(press.folder)
    assert facts(page)["Rounds read"].figures == [3]
    assert "Snapshots in s.ndjson that are left out here: 2 of another PLC and 2 incomplete." in page.text


def test_a_folder_of_another_format_has_no_series(press: Press, cli: Cli) -> None:
    done = cli("snapshot", "R5", "-o", "./", "--format", "csv", "--report", "x.html", "--force")
    assert done.code == 2
    assert one_line(done.err).endswith("expected --format json or ndjson, got csv")
    assert not list(press.folder.glob("snapshot-*"))


# --- the file -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("command", ["verify old.json", "diff old.json old.json", "watch R0", "snapshot R0"])
@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("old.json", "old.json exists and is not a report: it is not replaced; name another file"),
        ("no/x.html", "no is not a folder"),
        (".", ". is a folder, expected a file name"),
        ("/dev/null", "is a device"),
        ("-", "--report -: expected a file name"),
    ],
)
def test_where_a_report_cannot_be(press: Press, cli: Cli, command: str, name: str, said: str) -> None:
    """It is refused before the PLC is asked: this one is not even there."""
    before = press.old.read_bytes()
    target = [] if command.startswith("diff") else ["-p", "tcp://127.0.0.1:1"]
    done = cli(*command.split(), *target, "--report", name)
    assert (done.code, done.out) == (2, "")
    assert said in one_line(done.err)
    assert press.old.read_bytes() == before


def test_a_report_is_kept_or_replaced_and_nothing_else_is(press: Press, cli: Cli) -> None:
    words = ["diff", press.old, press.new, "--report", "x.html"]
    place = press.folder / "x.html"
    assert cli(*words).code == 1
    before = place.read_bytes()
    done = cli(*words)
    assert (done.code, done.out) == (2, "")
    assert one_line(done.err).endswith("x.html exists already and is kept; choose another name, or --force")
    assert place.read_bytes() == before
    assert cli(*words, "--force").code == 1
    place.write_text("<!doctype html><title>the boss's own page</title>")
    for more in ([], ["--force"]):
        assert cli(*words, *more).code == 2
        assert "boss" in place.read_text()
    done = cli("snapshot", "R0", "-o", "y.html", "--report", "y.html")
    assert done.code == 2  # the snapshot stands, its report does not
    assert json.loads((press.folder / "y.html").read_text())["values"] == {"R0": 0}


def test_a_target_that_cannot_be_printed(place: Path) -> None:
    """A name that is no UTF-8 comes from the shell as halves of characters."""
    done = process(
        "watch", "R0", "--count", "1", "--report", "x.html", "--force", redirect="-p $'sim:a\\xff<b>'"
    )
    assert done.code == 0, done.err
    assert r"station 1 on sim:a\udcff<b>" in report_of(place).text


def test_the_commands_of_the_documentation(press: Press, cli: Cli) -> None:
    shutil.copy(press.old, press.folder / "press.json")
    shutil.copy(press.new, press.folder / "monday.json")
    project_file("press.pdw", IMAGE)
    text = (ROOT / "docs" / "reports.md").read_text(encoding="utf-8")
    lines = re.findall(r"^\$ fatektool (.*)$", text, re.MULTILINE)
    assert {line.split()[0] for line in lines} == {
        "verify",
        "diff",
        "listing",
        "loopback",
        "watch",
        "snapshot",
    }
    for line in lines:
        assert cli(*line.split()).code == (1 if line.startswith("diff") else 0), line
        assert report_of(press.folder, line.split()[-1]).first("h1").text
    for number in (MOST_PAGES, MOST_POINTS, MOST_ROWS, MOST_CHARTS, MOST_DISCRETES, MOST_GAPS, MOST_DRAWN):
        assert f" {number} " in text.replace("|", " |")
