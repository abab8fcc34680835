"""Which PLC is written to: said before, said behind, and a warning where the file is another's."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from fatektool.cli.shared.addressee import Addressee, ExchangeTime, Origin
from fatektool.cli.shared.output import Voice
from fatektool.connection import connect
from fatektool.counts import spent
from fatektool.program.archive import save_backup
from tests.cli.running import NEW, served
from tests.program.samples import backup

if TYPE_CHECKING:
    from tests.cli.running import Cli, Press


@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
def test_a_backup_of_another_plc_is_a_warning(press: Press, cli: Cli, *, as_json: bool) -> None:
    other = press.folder / "other.json"
    save_backup(backup(NEW, target="/dev/ttyUSB7"), other)
    done = cli("restore", other, "-p", press.target, "--yes", *(["--json"] if as_json else []))
    assert done.code == 0
    said = f"warning: {other} is from station 1 on /dev/ttyUSB7, not from this PLC"
    assert done.err.splitlines()[0] == said
    if as_json:
        document = done.document("restore")
        assert document["source"] == {"target": "/dev/ttyUSB7", "station": 1, "time": "2026-11-22T03:15:00Z"}
        assert (document["target"], document["station"]) == (press.target, 1)
        assert document["model"] == "MC, 28 points, OS 3.1"
    else:
        rows = dict(line.split(maxsplit=1) for line in done.out.splitlines())
        assert rows["PLC"] == f"station 1 on {press.target}"
        assert rows["from"] == "station 1 on /dev/ttyUSB7, 2026-11-22T03:15:00Z"
        assert rows["model"] == "MC, 28 points, OS 3.1"
        assert "took" in rows


def test_a_snapshot_of_another_plc_is_a_warning(press: Press, cli: Cli) -> None:
    with served() as door:
        assert cli("snapshot", "R0-R3", "-o", "a.json", "-p", press.target).code == 0
        assert cli("write", "R0=5", "-p", door.target).code == 0
        done = cli("snapshot", "apply", "a.json", "-p", door.target, "--yes", "--json")
        assert (
            done.err.splitlines()[0]
            == f"warning: a.json is from station 1 on {press.target}, not from this PLC"
        )
        document = done.document("apply")
    assert (document["model"], document["mode"]) == ("FBE, 13K steps", "stop")
    assert document["source"]["target"] == press.target


def test_the_time_that_a_question_waits_is_not_counted() -> None:
    with connect("sim:") as plc:
        pace = ExchangeTime(plc)
        plc.brief_status()
        before_s = pace.passed_s
        assert before_s > 0
        with pace.stopped():
            plc.brief_status()
        assert pace.passed_s == pytest.approx(before_s)
        plc.brief_status()
        assert pace.passed_s > before_s


def test_one_line_by_two_names_is_no_other_plc(press: Press, cli: Cli) -> None:
    (press.folder / "link.state").symlink_to(press.state)
    done = cli("restore", press.new, "-p", f"sim:{press.folder}/link.state", "--yes")
    assert done.code == 0
    assert "warning" not in done.err


@pytest.mark.parametrize(
    ("origin", "warned"),
    [
        (Origin("tcp://HOST:500", 1, "then"), False),
        (Origin("tcp://host", 2, "then"), True),
        (Origin("tcp://other", 1, "then"), True),
        (Origin("", 1, "then"), True),
        (Origin("\0", 1, "then"), True),
    ],
)
def test_whatever_a_file_names(capsys: pytest.CaptureFixture[str], origin: Origin, *, warned: bool) -> None:
    origin.warn_unless_from(Addressee("tcp://host", 1), "x.json", Voice())
    assert bool(capsys.readouterr().err) == warned


@pytest.mark.parametrize(
    ("addressee", "line"),
    [
        (Addressee("COM3", 7), "station 7 on COM3"),
        (Addressee("COM3", 7, "code 40", running=True), "station 7 on COM3 (code 40, RUN)"),
        (Addressee("COM3", 7, None, running=False), "station 7 on COM3 (STOP)"),
    ],
)
def test_a_plc_on_one_line(addressee: Addressee, line: str) -> None:
    assert addressee.line == line


@pytest.mark.parametrize(
    ("seconds", "said"),
    [(0.0, "under 1 s"), (0.99, "under 1 s"), (1.0, "1 s"), (89.4, "89 s"), (240.0, "4 min")],
)
def test_a_time(seconds: float, said: str) -> None:
    assert spent(seconds) == said
