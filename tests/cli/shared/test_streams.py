"""Standard streams: pipes, full disks, closed ones. Data on stdout and nothing else."""

from __future__ import annotations

import errno
import io
import json
import os
import re
import shutil
import subprocess
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool.cli.shared.streams import Unheard
from fatektool.program.archive import Backup, load_backup
from fatektool.simulator.build import build_simulation
from tests.cli.running import OLD, Done, Press, environment, one_line, process, served, started
from tests.forks.command import COMMAND, PIPE, Forked
from tests.forks.shell import path as shell_path
from tests.guard import GUARD_S

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

CLOSED = {">&-": [1], "2>&-": [2], "<&-": [0], ">&- 2>&- <&-": [0, 1, 2]}
"""Redirections of a shell, as descriptors that a process has not."""


def redirected(*words: object, redirect: str = "", given: bytes = b"") -> Done:
    """Run a command with its streams as these redirections of a shell would have them."""
    with Path("/dev/full").open("wb") as full:
        command = Forked(
            words,
            stdin=PIPE,
            stdout=full if redirect.startswith("> /dev/full") else PIPE,
            stderr=full if redirect in {"2> /dev/full", "> /dev/full 2>&1"} else PIPE,
            closed=CLOSED.get(redirect, []),
            environment=environment(),
            text=False,
        )
    with command:
        out, err = command.communicate(given)
    return Done(command.wait(), *((data or b"").decode() for data in (out, err)))


def unread(*words: object, stream: str = "stdout", **more: str) -> Done:
    """Run a command of whose streams nobody reads this one."""
    reader, writer = os.pipe()
    os.close(reader)
    out, err = (writer, PIPE) if stream == "stdout" else (PIPE, writer)
    with Forked(words, stdout=out, stderr=err, environment=environment(**more)) as command:
        os.close(writer)
        texts = command.communicate()
    return Done(command.wait(), *(text or "" for text in texts))


@pytest.fixture(params=["", "1"], ids=["buffered", "unbuffered"])
def buffering(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Python keeps what it cannot write, and tries it again at its end; or not."""
    monkeypatch.setenv("PYTHONUNBUFFERED", request.param)


def test_a_backup_to_stdout_is_the_file(press: Press) -> None:
    process("backup", "x.json", "-p", press.target)
    filed = Path("x.json").read_bytes()
    done = process("backup", "-", "-p", press.target)
    assert done.code == 0
    assert done.err == ""
    created = Backup.parse(filed).created.encode(), Backup.parse(done.out.encode()).created.encode()
    assert done.out.encode() == filed.replace(created[0], created[1])
    assert process("backup", "-", "-p", press.target, "--json").out.count("\n") == done.out.count("\n")
    assert not Path("-").exists()


def test_a_backup_through_a_pipe(press: Press) -> None:
    assert process("backup", "-", "-p", press.target, redirect="> piped.json").code == 0
    assert load_backup(Path("piped.json")).program == OLD


@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize(
    "words",
    ["backup - -p sim:", "status -p sim:", "--help", "status -p sim: --json", "schema"],
)
def test_a_reader_that_is_gone(words: str, unbuffered: str) -> None:
    assert unread(*words.split(), PYTHONUNBUFFERED=unbuffered) == (141, "", "")


def test_a_reader_of_a_shell_that_is_gone() -> None:
    """A process of its own, as a user has it."""
    for unbuffered in ("", "1"):
        done = process("status", "-p", "sim:", redirect="| true", PYTHONUNBUFFERED=unbuffered)
        assert (done.code, done.err) in {(141, ""), (0, "")}  # it may have been quicker than the reader's end


@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_a_reader_that_has_seen_enough(
    press: Press, monkeypatch: pytest.MonkeyPatch, unbuffered: str
) -> None:
    """A program of 65535 words does not fit into a pipe: half of it is written."""
    monkeypatch.setenv("PYTHONUNBUFFERED", unbuffered)
    build_simulation(ladder_words=65535, state="large")
    with started("backup", "-", "-p", "sim:large", "--single-pass") as command:
        assert command.stdout is not None
        assert command.stderr is not None
        assert command.stdout.read(10) == '{\n "schema'
        command.stdout.close()
        assert command.stderr.read() == ""
    assert command.returncode == 141
    assert press.program == OLD


@pytest.mark.parametrize("as_json", [[], ["--json"]], ids=["words", "json"])
@pytest.mark.parametrize(
    ("words", "code"),
    [
        ("diff old.json new.json", 1),
        ("diff old.json old.json", 141),
        ("verify new.json -p sim:plc.state", 1),
        ("snapshot R0-R999 -p sim:", 141),
        ("snapshot R0-R999 R9000 -p sim:", 4),
        ("loopback --count 5 -p sim:", 141),
        ("watch R0 --count 3 --interval 0 -p sim:", 141),
        ("watch R0 R9000 --interval 0 -p sim:", 4),
    ],
)
def test_a_report_whose_command_nobody_reads(press: Press, words: str, code: int, as_json: list[str]) -> None:
    """What goes into files is whole, and the exit code is the job's; 141 where that would be 0."""
    assert press.new.exists()
    done = unread(*words.split(), "--report", "d.html", *as_json)
    assert done.code == code, done
    assert Path("d.html").read_text(encoding="utf-8").rstrip().endswith("</html>")


def test_a_restore_whose_words_nobody_reads(press: Press) -> None:
    assert unread("restore", press.new, "-p", press.target, "--yes").code == 141
    assert press.program == load_backup(press.new).program


SPEC = """
[[item]]
element = "R0"
name = "Öltemperatur €"
unit = "°C"
"""
LOCALES = [
    {"PYTHONIOENCODING": "cp1252"},
    {"PYTHONIOENCODING": "ascii:strict"},
    {"PYTHONIOENCODING": "utf-16"},
    {"PYTHONIOENCODING": "", "LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"},
]


IN_ONE = """
import os, sys
from fatektool.cli import main, run

run("snapshot --spec a.toml -p sim: -q -o first".split())  # what is loaded now is loaded in each child
for number, line in enumerate(sys.argv[1:]):
    if not os.fork():
        os.dup2(os.open(f"{number}.out", os.O_WRONLY | os.O_CREAT), 1)
        main(line.split())
    assert os.wait()[1] == 0, line
"""
"""Each command line in a child, whose interpreter was started once, with one locale."""


@pytest.mark.parametrize("locale", LOCALES, ids=lambda locale: "-".join(locale.values()))
def test_data_are_utf_8_whatever_the_locale_says(place: Path, locale: dict[str, str]) -> None:
    """On standard output the same bytes as in a file."""
    (place / "a.toml").write_text(SPEC, encoding="utf-8")
    forms = ("csv", "influx", "prometheus", "ndjson", "json")
    lines = [f"snapshot --spec a.toml -p sim: --format {form}" for form in forms]
    lines += [f"{line} -q -o {form}/a" for form, line in zip(forms, lines, strict=True)]
    for form in forms:
        (place / form).mkdir()
    done = subprocess.run(
        [sys.executable, "-c", IN_ONE, *lines], capture_output=True, check=False, env=environment(**locale)
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")

    def timeless(data: bytes) -> str:
        return re.sub(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ|\d{10}\d*|0\.\d+", "TIME", data.decode("utf-8"))

    for number, form in enumerate(forms):
        printed = (place / f"{number}.out").read_bytes()
        assert timeless(printed) == timeless((place / form / "a").read_bytes()), form
        if form in {"csv", "influx", "prometheus"}:
            assert "Öl" in printed.decode("utf-8"), form


@pytest.mark.parametrize("locale", LOCALES, ids=lambda locale: "-".join(locale.values()))
def test_words_bend_and_never_break(place: Path, locale: dict[str, str]) -> None:
    """On a terminal, and on stderr, what the encoding lacks is shown as a code."""
    (place / "Ω.json").write_text("{}", encoding="utf-8")
    done = subprocess.run(
        [*COMMAND, "inspect", "Ω.json"], capture_output=True, check=False, env=environment(**locale)
    )
    assert done.returncode == 5
    assert b"Traceback" not in done.stderr
    assert b"fault of fatektool" not in done.stderr.replace(b"\0", b"")


FULL = "> /dev/full"


@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
@pytest.mark.parametrize(
    "command", ["backup -", "status", "inspect old.json", "schema", "verify old.json", "ports"]
)
def test_stdout_on_a_full_disk(press: Press, command: str, *, as_json: bool) -> None:
    port = ["-p", press.target] if command.split(maxsplit=1)[0] in {"backup", "status", "verify"} else []
    done = redirected(*command.split(), *port, *(["--json"] if as_json else []), redirect=FULL)
    if command == "ports" and not as_json and done.code == 0:
        return  # this computer has none: nothing is printed
    assert done.code == 5
    line = one_line(done.err.splitlines()[-1])
    assert line.startswith(
        "fatektool: standard output cannot be written: No space left on device; free some space"
    )


@pytest.mark.parametrize("words", [["--help"], ["--version"]])
def test_help_on_a_full_disk(words: list[str]) -> None:
    assert redirected(*words, redirect=FULL).code == 5


REDIRECTIONS = (FULL, "2> /dev/full", ">&-", "2>&-", "> /dev/full 2>&1", ">&- 2>&- <&-")


@pytest.mark.usefixtures("buffering")
def test_an_error_keeps_its_exit_code_wherever_its_words_go(press: Press) -> None:
    refused, nowhere = ("restore", press.new, "-p", press.target), ("status", "-p", "/dev/nope")
    for option in ([], ["--json"]):
        for redirect in REDIRECTIONS:
            done = redirected(*refused, *option, redirect=redirect)
            assert done.code == 2, redirect
            assert "Traceback" not in done.err
            assert redirected(*nowhere, *option, redirect=redirect).code == 3, redirect
        for stream in ("stdout", "stderr"):
            assert unread(*refused, *option, stream=stream).code == 2, stream
            assert unread(*nowhere, *option, stream=stream).code == 3, stream


@pytest.mark.usefixtures("buffering")
def test_closed_streams_stop_no_command(press: Press) -> None:
    for number, redirect in enumerate((">&-", "2>&-", "<&-", ">&- 2>&- <&-", "2> /dev/full")):
        assert redirected("backup", f"{number}.json", "-p", press.target, redirect=redirect).code == 0
        assert load_backup(Path(f"{number}.json")).program == OLD


@pytest.mark.usefixtures("buffering")
@pytest.mark.parametrize("others", ["", " 2>&- <&-"])
def test_a_closed_stdout_is_as_dev_null_but_for_a_file(press: Press, others: str) -> None:
    """As git has it; a file that was to go there is nowhere, and that is no success."""
    for words, code in {
        "status": 0,
        "status --json": 0,
        "verify old.json": 0,
        "verify new.json --json": 1,
        "check --expect any": 0,
        "backup -": 5,
        "backup - --json": 5,
        "snapshot R0": 5,
        "snapshot R0 -o - --format csv": 5,
        "snapshot R0 -o r0.json --json": 0,
        "read R0": 0,
    }.items():
        done = redirected(*words.split(), "-p", press.target, redirect=f">&-{others}")
        assert done.code == code, words
        if code == 5 and not others:
            assert one_line(done.err).startswith("fatektool: standard output is closed: nothing was written")


def test_a_plugin_keeps_its_codes_wherever_its_words_go() -> None:
    for expected, code in (("any", 3), ("stop", 3), ("run", 2)):
        words = ("check", "-p", "sim:", "--expect", expected)
        assert unread(*words) == (code, "", "")
        done = redirected(*words, redirect=FULL)
        assert (done.code, "No space left on device" in one_line(done.err)) == (code, True)
        assert redirected(*words, redirect="2> /dev/full").code == (2 if expected == "run" else 0)
    assert unread("check", "-p", "/dev/nope").code == 2


@pytest.mark.usefixtures("buffering")
def test_streams_that_a_shell_closes_and_fills(press: Press) -> None:
    """As above, in interpreters of their own, which start without them."""
    assert process("backup", "x.json", "-p", press.target, redirect=">&- 2>&- <&-").code == 0
    assert load_backup(Path("x.json")).program == OLD
    assert process("restore", press.new, "-p", press.target, redirect="> /dev/full 2>&1").code == 2
    assert process("restore", press.new, "-p", press.target, redirect="2> >(true)").code == 2
    done = process("status", "-p", press.target, redirect=FULL)
    assert (done.code, one_line(done.err)[:39]) == (5, "fatektool: standard output cannot be wr")
    done = process("backup", "-", "-p", press.target, redirect=">&-")
    assert (done.code, one_line(done.err)[:36]) == (5, "fatektool: standard output is closed")


@pytest.mark.usefixtures("buffering")
def test_a_restore_goes_on_when_nobody_hears_it(press: Press) -> None:
    for redirect, code in (("2> /dev/full", 0), ("2>&-", 0), (FULL, 5), (">&-", 0)):
        for file in (press.new, press.old):
            done = redirected("restore", file, "-p", press.target, "--yes", "-v", redirect=redirect)
            assert done.code == code
            assert press.program == load_backup(file).program


@pytest.mark.usefixtures("buffering")
def test_a_restore_goes_on_when_its_terminal_is_gone(press: Press) -> None:
    """Under nohup, say: from the first page on, bar, messages and result have no place any more."""
    asked, gone = threading.Event(), threading.Event()
    master, slave = os.openpty()
    with served(OLD) as door:
        device = door.simulation.plcs[1]
        read = device.read_page

        def read_page(page: int) -> bytes:
            asked.set()
            assert gone.wait(GUARD_S)
            return read(page)

        device.read_page = read_page  # type: ignore[method-assign]  # to see it, and to wait
        words = ("restore", press.new, "-p", door.target, "--yes")
        with Forked(words, stdin=slave, stdout=slave, stderr=slave, environment=environment()) as command:
            os.close(slave)
            assert asked.wait(GUARD_S)
            os.close(master)
            gone.set()
            assert command.wait() == 5
        assert door.pages == load_backup(press.new).program.pages


def test_a_fleet_goes_on_when_its_words_are_lost(press: Press) -> None:
    names = ("one", "two", "three")
    tables = (f"[plc.{name}]\ntarget = '{press.target}-{name}'\n" for name in names)
    Path("fatek.toml").write_text("".join(tables))
    assert redirected("fleet", "backup", "--dir", "backups", redirect=FULL).code == 5
    assert {path.stem for path in Path("backups").glob("*.json")} == set(names)


class FullOnce(io.RawIOBase):
    """A file on a disk that is full at the first write."""

    def __init__(self) -> None:
        self.written: list[bytes] = []
        self._is_full = True

    def writable(self) -> bool:
        return True

    def write(self, data: ReadableBuffer) -> int:
        if self._is_full:
            self._is_full = False
            raise OSError(errno.ENOSPC, "No space left on device")
        self.written.append(bytes(data))
        return len(self.written[-1])


def test_a_message_that_is_lost_stops_no_later_one() -> None:
    disk = FullOnce()
    stream = io.TextIOWrapper(io.BufferedWriter(Unheard(disk)), "utf-8", line_buffering=True)
    for word in ("one", "two", "three"):
        stream.write(f"{word}\n")
    assert disk.written == [b"two\n", b"three\n"]


@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_a_disk_that_is_full_half_way(press: Press, unbuffered: str) -> None:
    """The first 8 kB fit: half a backup must not pass for a whole one."""
    words = ["backup", "-", "-p", "sim:", "--single-pass"]
    limits, env = {"RLIMIT_FSIZE": 8192}, environment(PYTHONUNBUFFERED=unbuffered)
    with Path("out").open("wb") as out, Forked(
        words, stdout=out, stderr=PIPE, environment=env, limits=limits
    ) as command:  # fmt: skip
        _, err = command.communicate()
    assert command.returncode == 5
    assert one_line(err).startswith("fatektool: standard output cannot be written: File too large")
    assert press.program == OLD


# --- standard input, and what the shell makes of > and < ----------------------------------------------------


def fed(words: str, data: bytes) -> Done:
    return redirected(*words.split(), given=data)


def test_a_program_is_read_from_standard_input(press: Press) -> None:
    """Wherever one is read: ``-`` is standard input. A restore needs ``--yes``, and saves where it stands."""
    old, new = press.old.read_bytes(), press.new.read_bytes()
    for word in ("-", "/dev/stdin"):
        done = fed(f"inspect {word} --raw {len(word)}.bin", old)
        assert (done.code, Path(f"{len(word)}.bin").read_bytes()) == (0, OLD.data)
        assert fed(f"verify {word} -p {press.target}", old).code == 0
        assert fed(f"diff {word} new.json", old).code == 1
        assert fed(f"diff new.json {word}", new).code == 0
    done = fed(f"restore - -p {press.target}", new)
    assert (done.code, "add --yes" in done.err) == (2, True)
    assert fed(f"restore - -p {press.target} --yes", new).code == 0
    assert press.program == load_backup(press.new).program
    (kept,) = Path().glob("stdin.safety-st01-*.json")
    assert load_backup(kept).program == OLD
    snapshot = fed(f"snapshot R0 -p {press.target}", b"").out.encode()
    assert fed("snapshot diff - -", snapshot).code == 2
    Path("s.json").write_bytes(snapshot)
    assert fed("snapshot diff - s.json", snapshot).code == 0
    assert fed(f"snapshot apply - -p {press.target} --yes", snapshot).code == 0
    assert fed(f"write R0=9 -p {press.target}", b"").code == 0
    assert fed(f"snapshot apply - -p {press.target} --yes", snapshot).code == 0
    assert len(list(Path().glob("stdin.safety-st01-*.json"))) == 2  # no name that begins with -


@pytest.mark.parametrize("words", ["inspect -", "diff - x.json", "snapshot diff - -", "link table check -"])
def test_standard_input_that_is_empty(words: str) -> None:
    done = fed(words, b"")
    assert done.code == 2
    assert "standard input is empty; use - only once" in done.err


@pytest.mark.skipif(shutil.which("gzip") is None, reason="needs gzip")
def test_pipes_of_the_shell(press: Press) -> None:
    """``>(…)`` and ``<(…)`` are files to a command."""
    target = f"-p {press.target}"

    def bash(command: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            ["bash", "-c", command],
            capture_output=True,
            text=True,
            check=False,
            env=environment(PATH=shell_path()),
        )

    assert (
        bash(f"fatektool backup >(gzip > x.gz) {target} && while ! gzip -t x.gz; do :; done").returncode == 0
    )
    assert bash("gzip -dc x.gz > x.json").returncode == 0
    assert load_backup(Path("x.json")).program == OLD
    assert bash("fatektool inspect <(gzip -dc x.gz)").returncode == 0
    assert bash(f"fatektool restore <(gzip -dc x.gz) {target} --dry-run").returncode == 0
    done = bash(f"fatektool snapshot R0 {target} -o /dev/stdout")
    assert (done.returncode, json.loads(done.stdout)["values"]) == (0, {"R0": 0})
    done = bash(f"fatektool snapshot R0 {target} -o /dev/stdout --format csv > x.csv")
    assert (done.returncode, Path("x.csv").read_text()[:5]) == (0, "time,")
    assert bash(f"fatektool backup /dev/stdout {target} > y.json").returncode == 0
    assert load_backup(Path("y.json")).program == OLD
    assert bash(f"fatektool snapshot R0 {target} -o >(cat > z.json); wait; sync").returncode == 0
