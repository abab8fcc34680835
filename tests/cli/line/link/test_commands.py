"""``link table`` at the command line, over a simulated PLC whose memory lies in a file."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import DataError
from fatektool.jobs.plcports.tables import read_table
from fatektool.plcports.kinds import TableKind
from fatektool.protocol.elements import Element
from tests.cli.terminal import Terminal
from tests.jobs.plcports.test_toml import WRITTEN
from tests.plant import Plant, cut_in_write, error_of, is_write, recorded, small, spied
from tests.plcports.samples import TABLES, put

if TYPE_CHECKING:
    from tests.cli.running import Cli


def held(plant: Plant, symbol: str, address: int, count: int) -> tuple[int, ...]:
    return tuple(plant.device.read_words(symbol, address, count))


@pytest.mark.parametrize("name", TABLES)
@pytest.mark.parametrize(("symbol", "address"), [("R", 500), ("D", 100), ("R", 5000)])
def test_save_write_save_is_the_identity(fbs: Plant, name: str, symbol: str, address: int) -> None:
    kind, words, _ = TABLES[name]
    put(fbs, f"{symbol}{address}", words)
    saved = fbs.json(
        "link-table", "link", "table", "save", f"{symbol}{address}", "a.toml", "--kind", kind.value
    )
    assert saved["words"] == [f"{word:04X}" for word in words]
    assert Path("a.toml").read_text(encoding="utf-8").startswith(f'kind = "{kind.value}"')
    document = fbs.json("link-write", "link", "table", "write", "a.toml", "R1000", "--yes")
    assert document["written"] + document["same"] == len(words)
    assert held(fbs, "R", 1000, len(words)) == words
    assert fbs.cli("link", "table", "save", "R1000", "b.toml", "--kind", kind.value).code == 0
    assert Path("a.toml").read_bytes() == Path("b.toml").read_bytes()
    again = fbs.cli("link", "table", "write", "b.toml", "R1000", "--yes")
    assert (again.code, again.out) == (0, "same: nothing was written\n")


def test_a_table_is_shown(fbs: Plant) -> None:
    put(fbs, "R500", TABLES["md0"][1])
    done = fbs.cli("link", "table", "show", "R500", "--kind", "md0", "--check")
    assert (done.code, done.err) == (0, "")
    assert done.out.splitlines() == [
        "no.  station  command  master      slave  length  result",
        "0    2        read     R0      <-  R100   4       0",
        "1    all      write    M8      ->  Y16    64      0",
        "all within the documented ranges",
    ]
    document = fbs.json("link-table", "link", "table", "show", "R500", "--kind", "md0")
    assert document["ok"] is True
    assert document["transactions"][1] == {
        "transaction": 1, "station": 0, "command": "write", "length": 64, "master": "M8", "slave": "Y16",
        "code": "0",
    }  # fmt: skip


def test_other_kinds_are_shown(fbs: Plant) -> None:
    for name, line in (
        ("md3", "1    2       high-speed  R32   ->  R32         16      0"),
        ("mbus", "1    3        write-single  Y7      ->  065535  1       0"),
        ("md1", "data        02 4F 4B 03"),
        ("md1", "text        .OK."),
        ("md2", "mode        81H, receive even with errors, then reply"),
    ):
        kind, words, _ = TABLES[name]
        put(fbs, "R500", words)
        assert line in fbs.cli("link", "table", "show", "R500", "--kind", kind.value).out.splitlines()


def test_faults_are_shown_with_the_result_that_they_give(fbs: Plant) -> None:
    put(fbs, "R500", (3, 2, 1, 65, 12, 0, 12, 0, 2, 9, 1, 20, 0, 12, 3840, 255, 1, 1, 0, 0, 6, 4))
    show = ("link", "table", "show", "R500", "--kind", "md0")
    types = ", ".join(map(str, range(14)))
    apart = "(result 6: the data types of master and slave are incompatible)"
    done = fbs.cli(*show)
    assert done.code == 0
    assert done.out.splitlines()[1:] == [
        "0    2        read     R0      <-  R0     65      2",
        "1    2        9        20:0    ?   R3840  1       3",
        "2    255      read     X0      <-  WX4    1       5",
        "transaction 0: length: expected 1 to 64, got 65 (result 2: length error: 0, or more than 64)",
        "transaction 1: command: expected 1 (read), 2 (write), got 9 (result 3: command code error)",
        f"transaction 1: master: type: expected one of {types}, got 20 (result 4: data type error)",
        "transaction 1: slave R3840: expected R0 to R3839 (result 5: reference number error)",
        "transaction 2: station: expected 0 to 254, got 255",
        "transaction 2: slave WX4: expected a multiple of 8 (result 5: reference number error)",
        f"transaction 2: master X0 are discretes, slave WX4 registers {apart}",
    ]
    assert fbs.cli(*show, "--check").code == 1
    document = fbs.json("link-table", *show)
    assert [row["code"] for row in document["transactions"]] == ["2", "3", "5"]
    assert document["faults"][4] == {
        "transaction": 2, "code": None, "meaning": None, "reason": "station: expected 0 to 254, got 255"
    }  # fmt: skip


def test_check_needs_no_plc(place: Path, cli: Cli) -> None:
    Path("t.toml").write_text(WRITTEN["mbus"], encoding="utf-8")
    done = cli("link", "table", "check", "t.toml")
    assert (done.code, done.err) == (0, "")
    Path("t.toml").write_text(WRITTEN["mbus"].replace("length = 10", "length = 126"), encoding="utf-8")
    assert cli("link", "table", "check", "t.toml").code == 1
    document = cli("link", "table", "check", "t.toml", "--json").document("link-table")
    assert (document["ok"], document["faults"][0]["code"], document["target"]) == (False, "2", None)
    assert place.exists()


def test_what_is_no_table_is_named(cli: Cli) -> None:
    assert "check the name" in error_of(cli("link", "table", "check", "none.toml"), 2)
    Path("t.toml").write_text(WRITTEN["md0"].replace('"read"', '"raed"'), encoding="utf-8")
    said = error_of(cli("link", "table", "check", "t.toml"), 5)
    assert "t.toml: transaction 0: command: expected" in said


def test_a_table_with_faults_is_not_written_unless_forced(
    fbs: Plant, monkeypatch: pytest.MonkeyPatch
) -> None:
    Path("t.toml").write_text(WRITTEN["md0"].replace("length = 64", "length = 65"), encoding="utf-8")
    sent = recorded(monkeypatch)
    said = error_of(fbs.cli("link", "table", "write", "t.toml", "R500", "--yes"), 5)
    assert "transaction 1: length: expected 1 to 64, got 65" in said
    assert "--force" in said
    assert not sent
    assert fbs.cli("link", "table", "write", "t.toml", "R500", "--yes", "--force").code == 0
    assert held(fbs, "R", 510, 1) == (65,)
    Path("t.toml").write_text(WRITTEN["md0"], encoding="utf-8")
    said = error_of(fbs.cli("link", "table", "write", "t.toml", "R3838", "--yes"), 5)
    assert "SR R3838: 15 words end at R3852, past R3839" in said
    said = error_of(fbs.cli("link", "table", "write", "t.toml", "WM0", "--yes"), 2)
    assert "SR WM0: expected a register R or D" in said
    said = error_of(fbs.cli("link", "table", "write", "t.toml", "D65530", "--yes", "--force"), 2)
    assert "15 registers from D65530 go past D65535" in said


def test_the_safety_snapshot_comes_first_and_goes_back(
    fbs: Plant, place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = tuple(range(100, 115))
    put(fbs, "R500", before)
    Path("t.toml").write_text(WRITTEN["md0"], encoding="utf-8")
    dry = fbs.cli("link", "table", "write", "t.toml", "R500", "--dry-run")
    assert dry.out.splitlines()[0] == f"PLC    station 1 on {fbs.target}"
    assert "R500  0064 -> 0002" in dry.out.splitlines()
    assert dry.out.splitlines()[-1] == "dry run: nothing was written"
    assert "add --yes" in error_of(fbs.cli("link", "table", "write", "t.toml", "R500"), 2)
    assert not list(place.glob("*.safety-*"))
    assert held(fbs, "R", 500, 15) == before
    kept: list[int] = []
    spied(
        monkeypatch, lambda data: kept.append(len(list(place.glob("t.safety-*")))) if is_write(data) else None
    )
    document = fbs.json("link-write", "link", "table", "write", "t.toml", "R500", "--yes")
    assert kept
    assert set(kept) == {1}
    assert held(fbs, "R", 500, 15) == TABLES["md0"][1]
    assert fbs.cli("snapshot", "apply", document["safety_snapshot"], "--yes").code == 0
    assert held(fbs, "R", 500, 15) == before
    done = fbs.cli("link", "table", "write", "t.toml", "R500", "--yes", "--no-safety-snapshot")
    assert "Previous values NOT saved: this write cannot be undone." in done.err


def test_a_line_that_fails_half_way(fbs: Plant, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("t.toml").write_text(WRITTEN["md0"], encoding="utf-8")
    write = ["link", "table", "write", "t.toml", "R500", "--yes", "--retries", "0", "--timeout", "0.01"]
    with monkeypatch.context() as cut:
        cut_in_write(cut, 1)
        done = fbs.cli(*write)
    assert done.code == 6
    assert "the table was not written completely" in done.err
    command = shlex.split(done.err.splitlines()[-1])
    assert command[:4] == ["fatektool", "link", "table", "write"]
    assert command[4:6] == ["-p", fbs.target]
    assert fbs.cli(*command[1:]).code == 0
    assert held(fbs, "R", 500, 15) == TABLES["md0"][1]


def test_what_does_not_take_is_named(fbs: Plant) -> None:
    """R3840 to R3903 are inputs, which take nothing."""
    Path("t.toml").write_text(WRITTEN["md1"], encoding="utf-8")
    done = fbs.cli("link", "table", "write", "t.toml", "R3838", "--yes", "--force")
    assert done.code == 4
    assert "warning: R3840: not kept: expected 0004, read back 0000" in done.err
    assert done.out.startswith("2 of 7 values written and read back")


@pytest.mark.parametrize(("answer", "code"), [("y", 0), ("n", 2)])
def test_on_a_terminal(fbs: Plant, place: Path, answer: str, code: int) -> None:
    Path("t.toml").write_text(WRITTEN["md0"], encoding="utf-8")
    with Terminal("link", "table", "write", "t.toml", "R500", "-p", fbs.target) as terminal:
        terminal.read_until("[y/N]")
        assert len(list(place.glob("t.safety-*"))) == 1
        terminal.type(f"{answer}\n")
        assert terminal.end() == code
    assert held(fbs, "R", 500, 1) == ((2,) if answer == "y" else (0,))


def test_a_running_plc_is_warned_of(fbs: Plant) -> None:
    fbs.change(running=True)
    Path("t.toml").write_text(WRITTEN["md0"], encoding="utf-8")
    done = fbs.cli("link", "table", "write", "t.toml", "R500", "--yes")
    assert (done.code, "the PLC is in RUN" in done.err) == (0, True)


def test_where_no_table_can_be(fb: Plant) -> None:
    said = error_of(fb.cli("link", "table", "show", "D3100", "--kind", "md0"), 4)
    assert "the PLC refused D3100" in said
    put(fb, "D3000", (255,))
    said = error_of(fb.cli("link", "table", "show", "D3000", "--kind", "md0"), 4)
    assert "1786 registers from D3000 were asked for, and the PLC refused D3072" in said
    Path("t.toml").write_text(WRITTEN["md0"], encoding="utf-8")
    said = error_of(fb.cli("link", "table", "write", "t.toml", "D3070", "--yes"), 4)
    assert "the PLC refused D3072, D3073, D3074, D3075, D3076 and 8 more" in said
    assert held(fb, "D", 3070, 2) == (0, 0)
    said = error_of(fb.cli("link", "table", "show", "M0", "--kind", "md0"), 2)
    assert "SR M0: expected a register R or D" in said
    said = error_of(fb.cli("link", "table", "show", "D65535", "--kind", "md1"), 2)
    assert "address out of range" in said
    assert error_of(fb.cli("link", "table", "show", "R0"), 2)
    assert error_of(fb.cli("link", "table", "show", "R0", "--kind", "md4"), 2)


def test_a_file_is_kept(fb: Plant, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("t.toml").write_text("mine", encoding="utf-8")
    sent = recorded(monkeypatch)
    assert "exists already" in error_of(fb.cli("link", "table", "save", "R0", "t.toml", "--kind", "md0"), 2)
    assert not sent
    done = fb.cli("link", "table", "save", "R0", "t.toml", "--kind", "md0", "--force")
    assert done.code == 0
    assert "1 fault" in done.err
    assert Path("t.toml").read_text(encoding="utf-8") == 'kind = "md0"\n'


def test_a_table_that_changes_its_length_is_read_again(monkeypatch: pytest.MonkeyPatch) -> None:
    plc = small().plc
    reads = [[1], [2, *range(7)], [2, *TABLES["md0"][1][1:]]]
    monkeypatch.setattr("fatektool.jobs.plcports.tables.read_words", lambda *_: tuple(reads.pop(0)))
    assert read_table(plc, Element("R", 0), TableKind.MD0) == TABLES["md0"][2]
    assert not reads
    reads += [[1], [2], [1], [2]]
    with pytest.raises(DataError, match="changes its length while it is read"):
        read_table(plc, Element("R", 0), TableKind.MD0)
