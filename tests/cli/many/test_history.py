"""The ``history`` commands: what they print, each document by its schema, each error by its class."""

from __future__ import annotations

import re
import sys

import pytest

from fatektool.program.archive import load_backup, save_backup
from tests.cli.running import Cli, check, one_line, process
from tests.history.books import ONE, TWO, Book, git


@pytest.fixture
def cli(book: Book, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Cli:
    """In a folder with two backups; the history is named by the environment."""
    monkeypatch.setenv("FATEKTOOL_HISTORY", book.folder.name)
    save_backup(ONE, book.folder.parent / "one.json")
    save_backup(TWO, book.folder.parent / "two.json")
    return Cli(capsys)


@pytest.fixture
def filled(cli: Cli) -> Cli:
    for name, file in (("press", "one.json"), ("saw", "one.json"), ("press", "two.json")):
        assert cli("history", "record", name, file).code == 0
    return cli


def test_record(cli: Cli, book: Book) -> None:
    first = cli("history", "record", "press", "one.json", "--json").document("history-record")
    assert (first["changed"], first["pages_differ"], first["push"]) == (True, None, None)
    again = cli("history", "record", "press", "one.json")
    assert again == (0, "unchanged  press: the newest program in plc-history is the same\n", "")
    document = cli("history", "record", "press", "one.json", "--json").document("history-record")
    assert (document["changed"], document["revision"], document["words_differ"]) == (False, None, 0)
    done = cli("history", "record", "press", "two.json")
    assert done.out == (
        f"recorded  press: 2 words in 2 pages changed\nrevision  {book.git('rev-parse', 'HEAD').strip()}\n"
    )


def test_record_and_push(cli: Cli, book: Book) -> None:
    git(book.folder.parent, "init", "--quiet", "--bare", "nas")
    done = cli("history", "record", "press", "one.json", "--push", "nas", "--json")
    assert done.document("history-record")["push"]["sent"] is True
    done = cli("history", "record", "press", "one.json", "--push", "nas")
    assert done.out.splitlines()[1] == "pushed     nas is up to date"
    failed = cli("history", "record", "press", "two.json", "--push", "nowhere")
    assert failed.code == 3
    assert failed.out.startswith("recorded  press: 2 words in 2 pages changed\n")
    assert "could not push to nowhere: the folder does not exist; nothing is lost" in one_line(failed.err)
    failed = cli("history", "record", "saw", "two.json", "--push", "nowhere", "--json")
    error = failed.document("error")["error"]
    assert (error["kind"], error["exit_code"]) == ("push_failed", 3)
    assert error["details"]["recorded"] == book.git("rev-parse", "HEAD").strip()


def test_a_damaged_file_is_warned_of(filled: Cli, book: Book) -> None:
    sha = book.git("rev-parse", "HEAD:press.json").strip()
    (book.folder / "objects" / sha[:2] / sha[2:]).write_bytes(b"")
    done = filled("history", "record", "press", "one.json")
    assert done.code == 0
    assert done.err.startswith("warning: the previous backup cannot be read: plc-history: object")


def test_log(filled: Cli) -> None:
    line = r"[0-9a-f]{10}  20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ  "
    done = filled("history", "log")
    assert re.fullmatch(
        f"{line}press: 2 words in 2 pages changed\n{line}saw: first backup\n{line}press: first backup\n",
        done.out,
    )
    assert len(filled("history", "log", "saw").out.splitlines()) == 1
    document = filled("history", "log", "press", "-n", "1", "--json").document("history-log")
    assert [change["subject"] for change in document["changes"]] == ["press: 2 words in 2 pages changed"]
    assert document["more"] is True
    assert filled("history", "log", "-n", "3", "--json").document("history-log")["more"] is False


def test_log_of_a_history_that_begins(cli: Cli, book: Book) -> None:
    git(book.folder.parent, "init", "--quiet", "--bare", str(book.folder))
    assert cli("history", "log") == (0, "", "no program is recorded in plc-history yet\n")


def test_show(filled: Cli) -> None:
    done = filled("history", "show", "press@~1")
    assert re.search(r"^recorded     20\S+Z: press: first backup$", done.out, re.MULTILINE)
    assert ONE.program.sha256 in done.out
    document = filled("history", "show", "press", "--json").document("history-show")
    assert document["sha256"] == TWO.program.sha256
    assert filled("history", "show", f"press@{document['revision'][:8]}", "--json").out == filled(
        "history", "show", "press", "--json"
    ).out  # fmt: skip


def test_diff(filled: Cli, book: Book) -> None:
    done = filled("history", "diff", "press", "--report", "x.html")
    assert done.code == 1
    assert re.match(r"differs: 2 words in 2 pages \(press@\w{10} -> press@\w{10}\)\npages 3, ", done.out)
    assert "<title>" in (book.folder.parent / "x.html").read_text(encoding="utf-8")
    document = filled("history", "diff", "press", "HEAD", "~1", "--json").document("diff")
    assert document["a"]["sha256"] == TWO.program.sha256
    assert document["pages_differ"] == 2
    assert filled("history", "diff", "press", "HEAD").code == 0
    assert filled("history", "diff", "saw").code == 2


def test_check(filled: Cli, book: Book) -> None:
    assert filled("history", "check") == (0, "no damage: 3 commits, 2 programs, 2 PLCs now\n", "")
    assert filled("history", "check", "--json").document("history-check")["whole"] is True
    sha = book.git("rev-parse", "HEAD:press.json").strip()
    (book.folder / "objects" / sha[:2] / sha[2:]).unlink()
    done = filled("history", "check")
    assert done.code == 1
    assert re.match(r"damaged: 1 fault in 3 commits, 1 program, 2 PLCs now\n  press@\w{10}: ", done.out)
    document = filled("history", "check", "--json").document("history-check")
    assert [fault["name"] for fault in document["faults"]] == ["press"]


def test_export(filled: Cli, book: Book) -> None:
    place = book.folder.parent / "before.json"
    document = filled("history", "export", "press@~1", place, "--json").document("history-export")
    assert document["sha256"] == ONE.program.sha256
    assert load_backup(place) == ONE
    assert "exists already and is kept" in one_line(filled("history", "export", "press", place).err)
    assert filled("history", "export", "press", place, "--force").code == 0
    assert load_backup(place) == TWO


def test_export_to_stdout(filled: Cli) -> None:
    assert filled("history", "log").code == 0
    done = process("history", "export", "saw", "-")
    assert (done.code, done.out.encode(), done.err) == (0, ONE.to_bytes(), "")


@pytest.mark.parametrize(
    ("code", "words", "message"),
    [
        (2, "log nope", "no PLC 'nope' in the history plc-history"),
        (2, "show pres", "did you mean press"),
        (2, "show press@", "expected a revision after the @"),
        (2, "show press@yesterday", "'yesterday' is not a revision"),
        (2, "diff press ~7", "there is no revision press@~7"),
        (2, "log -n 0", "0 is not in the range"),
        (2, "log --history nope", "there is no history nope; 'fatektool history record' creates it"),
        (2, "record ../x one.json", "'../x' is not a valid name for a PLC"),
        (
            2,
            "record x one.json --history .",
            "neither empty nor a bare git repository: it contains 'bad.json'",
        ),
        (2, "record x none.json", "cannot read none.json: No such file"),
        (2, "export press one.json", "one.json exists already"),
        (2, "export press no/x.json", "no is not a folder"),
        (2, "frobnicate", "no such command 'frobnicate'"),
        (5, "check --history .", ". is not a git repository"),
        (5, "record x bad.json", "bad.json: not a backup file"),
        (5, "show press --history work", "has a work tree: expected a bare repository"),
    ],
)
def test_errors(filled: Cli, book: Book, code: int, words: str, message: str) -> None:
    tmp_path = book.folder.parent
    git(tmp_path, "init", "--quiet", "work")
    (tmp_path / "bad.json").write_bytes(b"{}")
    before = book.git("rev-parse", "HEAD")
    done = filled("history", *words.split())
    assert (done.code, done.out) == (code, "")
    assert message in one_line(done.err)
    assert book.git("rev-parse", "HEAD") == before
    check(filled("history", *words.split(), "--json").document("error"), "error")


def test_no_history_named(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("FATEKTOOL_HISTORY")
    assert "no history is given; give --history DIR, set FATEKTOOL_HISTORY, or" in cli("history", "log").err


@pytest.mark.skipif(sys.platform == "win32", reason="needs a POSIX shell")
def test_other_commands_do_without_dulwich() -> None:
    program = (
        "from fatektool.cli import run; run(['status', '-p', 'sim:']); import sys; print([*sys.modules])"
    )
    from subprocess import run

    done = run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert "'dulwich" not in done.stdout
