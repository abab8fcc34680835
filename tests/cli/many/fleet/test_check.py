"""``check`` and ``fleet check``: a monitoring plugin's line, figures and exit code, for each state."""

from __future__ import annotations

import re
from datetime import UTC, datetime, timedelta
from itertools import permutations
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import UsageError
from fatektool.jobs.check.age import age_words, parse_age
from fatektool.jobs.check.plc import check_backup
from fatektool.jobs.check.result import CheckResult, State, worst
from fatektool.program.archive import Backup, save_backup
from fatektool.program.image import Program
from fatektool.transport.lock import PortLock
from tests.cli.many.fleet.gateway import deaf_door, plcs_of
from tests.cli.running import NEW, OLD, process
from tests.program.samples import backup, changed

if TYPE_CHECKING:
    from collections.abc import Callable

    from tests.cli.many.fleet.gateway import Hall
    from tests.cli.running import Cli

LINE = re.compile(r"FATEK (OK|WARNING|CRITICAL|UNKNOWN) - ([^|]+?)(?: \| (.*))?\n")
FIGURE = re.compile(r"[a-z_]+=-?[\d.]+(?:s|)(?:;[\d.]*){0,3}")  # the guidelines' performance data


def plugin(cli: Cli, *words: str) -> tuple[int, str, dict[str, str]]:
    """Exit code, words and figures; the state's word and the code must agree."""
    done = cli("check", *words)
    match = LINE.fullmatch(done.out)
    assert match is not None, done
    assert State[match[1]] == done.code
    figures = (match[3] or "").split()
    assert all(FIGURE.fullmatch(figure) for figure in figures)
    return done.code, match[2], dict(figure.split("=") for figure in figures)


def kept(image: Program, name: str, age: timedelta = timedelta()) -> None:
    found = backup(image)
    created = (datetime.now(UTC) - age).strftime("%Y-%m-%dT%H:%M:%SZ")
    save_backup(Backup(found.program, created, found.tool, found.source, found.plc, found.passes), Path(name))


def test_ok(cli: Cli, plant: Hall) -> None:
    plant.press.running = True
    kept(OLD, "press.json", timedelta(hours=3))
    code, words, figures = plugin(
        cli, "-p", "press", "--reference", "press.json", "--backup", "press.json", "--max-age", "36h",
        "--expect", "run",
    )  # fmt: skip
    told = "press: RUN, ladder checksum ok, battery ok, program as in press.json, backup 3 h old"
    assert (code, words) == (0, told)
    assert (figures["running"], figures["battery_low"], figures["words_differ"]) == ("1", "0", "0")
    assert figures["backup_age"].endswith("s;129600;;0")
    assert re.fullmatch(r"0\.\d{4}s;;;0", figures["response"])


@pytest.mark.parametrize(
    ("flag", "code", "words"),
    [
        ("battery_low", 1, "battery LOW"),
        ("emergency_stop", 1, "emergency stop ACTIVE"),
        ("ladder_checksum_error", 2, "ladder checksum ERROR"),
        ("watchdog", 2, "watchdog TIMED OUT"),
    ],
)
def test_a_flag(cli: Cli, plant: Hall, flag: str, code: int, words: str) -> None:
    setattr(plant.press, flag, True)
    found = plugin(cli, "-p", "press")
    assert found[0] == code
    assert found[1].startswith(f"press: {words}")  # the worst first


@pytest.mark.parametrize(
    ("expect", "running", "code"),
    [("run", True, 0), ("run", False, 2), ("stop", True, 2), ("stop", False, 0), ("any", True, 0)],
)
def test_the_mode(cli: Cli, plant: Hall, expect: str, *, running: bool, code: int) -> None:
    plant.press.running = running
    assert plugin(cli, "-p", "press", "--expect", expect)[0] == code
    plant.write(press=f'expect = "{expect}"\n')
    assert plugin(cli, "-p", "press")[0] == code


def test_without_an_inventory_it_ought_to_run(cli: Cli, plant: Hall) -> None:
    code, words, _ = plugin(cli, "-p", plant.targets[0])
    assert code == 2
    assert words.startswith(f"{plant.targets[0]}: in STOP, expected RUN")


def test_the_program(cli: Cli, plant: Hall) -> None:
    kept(changed(OLD, 2, 3), "press.json")
    plant.write(press='reference = "press.json"\n')
    code, words, figures = plugin(cli, "-p", "press")
    assert (code, figures["words_differ"]) == (2, "2")
    assert "program DIFFERS from press.json: 2 words in 2 pages" in words
    assert plugin(cli, "-p", "press", "--no-reference")[0] == 0
    Path("press.json").write_text("{}")
    assert plugin(cli, "-p", "press")[0] == 3  # nobody can tell
    plant.press.program_commands = False
    kept(OLD, "other.json")
    code, words, _ = plugin(cli, "-p", "press", "--reference", "other.json")
    assert code == 3
    assert "refused to read program page 0" in words


def missing(path: Path) -> str:
    return f"cannot read {path}: No such file"


def damaged(path: Path) -> str:
    path.write_text('{"schema": "fatektool.backup/1"')
    return str(path)


def denied(path: Path) -> str:
    path.mkdir()
    return f"cannot read {path}"


@pytest.mark.parametrize("spoil", [missing, damaged, denied])
def test_a_reference_that_is_none_hides_nothing(cli: Cli, plant: Hall, spoil: Callable[[Path], str]) -> None:
    """The PLC is asked first, and what it says, or does not say, outweighs what could not be compared."""
    said = spoil(Path("gone.json"))
    plant.write(press='reference = "gone.json"\nexpect = "run"\n')
    plant.press.running = True
    code, words, figures = plugin(cli, "-p", "press")
    assert (code, figures["running"]) == (3, "1")
    assert f"program NOT COMPARED: {said}" in words
    plant.press.battery_low = True
    code, words, _ = plugin(cli, "-p", "press")
    assert code == 1
    assert words.startswith("press: battery LOW, program NOT COMPARED")
    plant.press.running = False
    assert plugin(cli, "-p", "press")[0] == 2
    assert cli("fleet", "check", "--select", "press").code == 2
    with deaf_door() as target:
        plant.write(deaf=f'target = "{target}"\ntimeout_s = 0.05\nreference = "gone.json"\n')
        code, words, _ = plugin(cli, "-p", "deaf")
        assert (code, "no answer from station 1" in words) == (2, True)
        assert cli("fleet", "check", "--select", "deaf").code == 2


@pytest.mark.parametrize("file", ["no/folder/x.prom", "folder.prom"])
def test_figures_that_cannot_be_written_hide_nothing(cli: Cli, plant: Hall, file: str) -> None:
    Path("folder.prom").mkdir()
    plant.write(press='expect = "run"\n')
    code, words, _ = plugin(cli, "-p", "press", "--prometheus", file)
    assert (code, words.startswith("press: in STOP, expected RUN")) == (2, True)
    plant.press.running = True
    code, words, _ = plugin(cli, "-p", "press", "--prometheus", file)
    assert (code, "figures NOT WRITTEN: " in words) == (3, True)
    document = cli("check", "-p", "press", "--prometheus", file, "--json").document("check")
    assert document["state"] == "UNKNOWN"
    fleet = cli("fleet", "check", "--prometheus", file)
    assert (fleet.code, fleet.out.count("figures NOT WRITTEN: ")) == (3, 1)
    plant.press.running = False
    fleet = cli("fleet", "check", "--prometheus", file)
    assert (fleet.code, fleet.out.count("figures NOT WRITTEN: ")) == (2, 1)


def test_a_folder_of_backups_that_is_gone_is_critical(cli: Cli, plant: Hall) -> None:
    plant.press.running = True
    done = cli("fleet", "check", "--backups", "gone", "--select", "press")
    assert done.code == 2
    assert "press: NO GOOD BACKUP: cannot read gone/press.json" in done.out


def test_a_battery_outweighs_a_program_that_cannot_be_compared(cli: Cli, plant: Hall) -> None:
    plant.press.battery_low = True
    plant.press.program_commands = False
    kept(OLD, "press.json")
    assert plugin(cli, "-p", "press", "--reference", "press.json")[0] == 1


def test_unreachable(cli: Cli, plant: Hall) -> None:
    kept(OLD, "dead.json")
    with deaf_door() as target:
        plant.write(deaf=f'target = "{target}"\ntimeout_s = 0.05\n')
        code, words, _ = plugin(cli, "-p", "deaf")
        assert code == 2
        assert "no answer from station 1" in words
        code, words, figures = plugin(cli, "-p", "deaf", "--backup", "dead.json", "--max-age", "1d")
        assert code == 2
        assert re.search(r"backup \d+ s old", words)
        assert "backup_age" in figures
    assert plugin(cli, "-p", "/dev/nope")[0] == 2


def test_a_line_in_use_tells_nothing(cli: Cli, plant: Hall) -> None:
    lock = PortLock(plant.targets[0].removeprefix("tcp://"), 0)
    lock.acquire()
    try:
        code, words, _ = plugin(cli, "-p", "press", "--lock-wait", "0")
    finally:
        lock.release()
    assert code == 3
    assert "is in use by process" in words


def test_a_target_is_named_once(cli: Cli) -> None:
    _, words, _ = plugin(cli, "-p", "/dev/no-such-port")
    assert words == "/dev/no-such-port: no such port"


def test_it_is_over_at_its_deadline(cli: Cli, plant: Hall) -> None:
    with deaf_door() as target:
        plant.write(deaf=f'target = "{target}"\ntimeout_s = 0.05\nretries = 1000\n')
        code, words, _ = plugin(cli, "-p", "deaf", "--deadline", "0.2")
    assert code == 2
    assert "deaf: " in words


@pytest.mark.parametrize(
    ("age", "state", "words"),
    [
        (timedelta(hours=35), State.OK, "backup 35 h old"),
        (timedelta(hours=37), State.WARNING, "backup 37 h OLD, expected at most 36 h"),
        (timedelta(minutes=-10), State.OK, "backup 0 s old"),
        (timedelta(hours=-2), State.WARNING, "backup DATED IN THE FUTURE, "),
    ],
)
@pytest.mark.usefixtures("place")
def test_the_age_of_a_backup(age: timedelta, state: State, words: str) -> None:
    kept(OLD, "press.json", age)
    found = CheckResult()
    check_backup(Path("press.json"), found, max_age_s=36 * 3600, now=datetime.now(UTC))
    assert found.state is state
    assert found.words.startswith(words)


@pytest.mark.usefixtures("place")
def test_a_backup_without_its_program_is_none() -> None:
    pages = (OLD.pages[0], *[b"\xff" * 128] * 7)
    kept(Program(400, pages), "empty.json")
    text = backup(OLD).to_bytes()
    Path("cut.json").write_bytes(text[: text.index(b'"pages"')] + b'"pages": []}')
    for name, words in (
        ("empty.json", "the program is empty: every byte of its ladder is FF"),
        ("cut.json", "cut.json: pages: expected 8 for 400 words, got 0"),
        ("no.json", "cannot read no.json"),
    ):
        found = CheckResult()
        check_backup(Path(name), found, max_age_s=None, now=datetime.now(UTC))
        assert found.state is State.CRITICAL
        assert found.words.startswith(f"NO GOOD BACKUP: {words}")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("-p press --nope", "No such option"),
        ("-p pres", "no PLC 'pres' in the inventory"),
        ("", "no PLC named"),
        ("-p press --max-age 1h", "--max-age goes with --backup"),
        ("-p press --backup x --max-age 36", "expected a number and s, m, h or d"),
        ("-p press --reference x --no-reference", "does not go with"),
        ("-p press --reference no.json", "cannot read no.json"),
        ("-p press -s 300", "expected a whole number from 1 to 254, over modbus-tcp 0 and 255 too, got 300"),
        ("-p press --on-failure 'x", "No closing quotation"),
        ("-p press --prometheus x.txt", "expected a name that ends in .prom"),
    ],
)
def test_a_wrong_command_line_is_unknown(cli: Cli, plant: Hall, words: str, message: str) -> None:
    assert plant.targets
    code, told, _ = plugin(cli, *words.split(" ") if words else [])
    assert code == 3
    assert message in told
    assert cli("check", *(words.split(" ") if words else []), "--json").document("check")["exit_code"] == 3


def test_a_fault_of_ours_and_an_interrupt_are_unknown(
    cli: Cli, plant: Hall, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert plant.targets
    raised: BaseException = ZeroDivisionError("oops")

    def fail(*_: object, **__: object) -> None:
        raise raised

    monkeypatch.setattr("fatektool.cli.many.run_check.check_plc", fail)
    assert plugin(cli, "-p", "press")[1] == "a fault of fatektool itself: ZeroDivisionError: oops"
    raised = KeyboardInterrupt()
    assert plugin(cli, "-p", "press")[:2] == (3, "interrupted")


def test_a_bar_would_end_the_words(cli: Cli, plant: Hall) -> None:
    assert plant.targets
    assert plugin(cli, "-p", "a|b")[1].startswith("no PLC 'a/b' in the inventory")


def test_help_is_help(cli: Cli) -> None:
    assert cli("check", "--help").code == 0


def test_the_document(cli: Cli, plant: Hall) -> None:
    plant.press.battery_low = True
    document = cli("check", "-p", "press", "--json").document("check")
    assert (document["name"], document["state"], document["exit_code"]) == ("press", "WARNING", 1)
    assert {"state": "WARNING", "words": "battery LOW"} in document["facts"]


# --- many --------------------------------------------------------------------------------------------------


def test_fleet_check(cli: Cli, plant: Hall) -> None:
    done = cli("fleet", "check")
    assert done.code == 0
    assert re.fullmatch(
        r"FATEK OK - 3 of 3 PLCs OK \| ok=3 warning=0 critical=0 unknown=0 duration=[\d.]+s;;;0\n", done.out
    )
    plant.pump.battery_low = True
    plant.oven.watchdog = True
    done = cli("fleet", "check")
    assert done.code == 2
    first, *rest = done.out.splitlines()
    assert first.startswith("FATEK CRITICAL - 1 of 3 PLCs OK; 1 CRITICAL: oven; 1 WARNING: pump | ok=1 ")
    assert [line.partition(",")[0] for line in rest] == [
        "CRITICAL - oven: watchdog TIMED OUT",
        "WARNING - pump: battery LOW",
    ]
    assert cli("fleet", "check", "--select", "pump").code == 1
    assert len(cli("fleet", "check", "-v").out.splitlines()) == 4


def test_fleet_check_with_backups_and_references(cli: Cli, plant: Hall) -> None:
    for name, image in (("press", OLD), ("oven", NEW)):
        kept(image, f"backups/{name}.json")
    plant.write(press='reference = "backups/oven.json"\n')
    done = cli("fleet", "check", "--backups", "backups", "--max-age", "1d", "--json")
    document = done.document("fleet")
    assert (done.code, document["state"]) == (2, "CRITICAL")
    found = plcs_of(document)
    assert [plc["exit_code"] for plc in found.values()] == [2, 0, 2]
    assert "DIFFERS" in found["press"]["words"]
    assert "NO GOOD BACKUP: cannot read backups/pump.json" in found["pump"]["words"]


@pytest.mark.parametrize("words", ["--select x", "--nope", "--max-age 1h", "--inventory no.toml"])
def test_fleet_check_has_its_own_code_space_too(cli: Cli, plant: Hall, words: str) -> None:
    assert plant.targets
    done = cli("fleet", "check", *words.split())
    assert done.code == 3
    assert LINE.fullmatch(done.out)


def test_as_a_process(plant: Hall) -> None:
    assert plant.targets
    done = process("check", "-p", "press")
    assert (done.code, done.err) == (0, "")
    assert LINE.fullmatch(done.out)


# --- values ------------------------------------------------------------------------------------------------


def test_the_worst() -> None:
    order = [State.CRITICAL, State.WARNING, State.UNKNOWN, State.OK]
    for states in permutations(order):
        assert worst(states) is State.CRITICAL
        for number in range(4):
            assert worst(states[:number]) is min(states[:number], key=order.index, default=State.OK)


@pytest.mark.parametrize(
    ("text", "seconds"), [("36h", 129600), ("90m", 5400), ("7d", 604800), ("1.5h", 5400), ("10s", 10)]
)
def test_an_age(text: str, seconds: float) -> None:
    assert parse_age(text) == seconds


@pytest.mark.parametrize("text", ["", "36", "h", "-1h", "1w", "1e3h", "nanh", "1 h"])
def test_no_age(text: str) -> None:
    with pytest.raises(UsageError, match="--max-age"):
        parse_age(text)


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(0, "0 s"), (119, "119 s"), (120, "2 m"), (7200, "2 h"), (129600, "36 h"), (172800, "2 d")],
)
def test_an_age_in_words(seconds: float, words: str) -> None:
    assert age_words(seconds) == words
