"""``diff``, ``verify``, ``inspect``, ``restore`` and ``history`` of programs that can be read."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool.program.archive import Backup, save_backup
from tests.cli.running import served
from tests.program.samples import backup, program
from tests.project.files import ELEMENTS, IMAGE, MAIN, SUB, backup_file, program_of, project_file
from tests.project.images import B1, CODE, image_of

if TYPE_CHECKING:
    from tests.cli.running import Cli

NEGATED = image_of([*MAIN[:2], 0x0080, *MAIN[3:]], SUB)
INSERTED = image_of([*MAIN[:4], 0x0740, 0x07C1, *MAIN[4:]], SUB)
SETTINGS = image_of(MAIN, SUB, settings=7)
HUNK = [
    "networks: N0000 changed",
    "--- {a}",
    "+++ {b}",
    "@@ N0000 changed @@",
    " ORG X0",
    " OR M0",
    "-AND NOT X0",
    "+AND X0",
    " OUT Y0",
]


def hunk(a: str, b: str) -> list[str]:
    return [line.format(a=a, b=b) for line in HUNK]


@pytest.mark.parametrize("swapped", [False, True])
def test_a_project_and_a_backup_of_the_same_program(cli: Cli, swapped: bool) -> None:
    backup_file("press.json", IMAGE, swapped=swapped)
    project_file("press.pdw", IMAGE, elements=ELEMENTS)
    for files in (("press.json", "press.pdw"), ("press.pdw", "press.json"), ("press.pdw", "press.pdw")):
        done = cli("diff", *files)
        assert (done.code, done.out) == (0, "same: 320 pages, same code\n")
        document = cli("diff", *files, "--json").document("diff")
        assert (document["same"], document["networks"], document["differences"]) == (True, [], [])


def test_a_contact_negated_is_one_line_in_one_network(cli: Cli) -> None:
    backup_file("a.json", IMAGE)
    backup_file("b.json", NEGATED)
    done = cli("diff", "a.json", "b.json")
    assert done.code == 1
    assert done.out.splitlines()[-9:] == hunk("a.json", "b.json")
    document = cli("diff", "a.json", "b.json", "--json").document("diff")
    lines = [" ORG X0", " OR M0", "-AND NOT X0", "+AND X0", " OUT Y0"]
    assert document["networks"] == [{"change": "changed", "a": 0, "b": 0, "lines": lines}]


def test_a_network_put_in_is_one_addition(cli: Cli) -> None:
    backup_file("a.json", IMAGE)
    project_file("b.pdw", INSERTED)
    done = cli("diff", "a.json", "b.pdw")
    assert done.code == 1
    assert done.out.splitlines()[-6:] == [
        "networks: N0001 added",
        "--- a.json",
        "+++ b.pdw",
        "@@ N0001 added @@",
        "+ORG X7",
        "+OUT Y7",
    ]
    (change,) = cli("diff", "b.pdw", "a.json", "--json").document("diff")["networks"]
    assert change == {"change": "removed", "a": 1, "b": None, "lines": ["-ORG X7", "-OUT Y7"]}


def test_the_same_code_under_another_header(cli: Cli) -> None:
    backup_file("a.json", IMAGE)
    backup_file("b.json", SETTINGS)
    done = cli("diff", "a.json", "b.json")
    assert done.code == 1
    assert done.out.splitlines()[-1] == "same code: 25 words in 6 networks; what differs is not code"
    assert cli("diff", "a.json", "b.json", "--json").document("diff")["networks"] == []


def test_the_same_program_in_two_orders_of_bytes(cli: Cli) -> None:
    backup_file("a.json", IMAGE)
    backup_file("b.json", IMAGE, swapped=True)
    done = cli("diff", "a.json", "b.json")
    assert done.code == 1
    assert "same code: 25 words in 6 networks; the two bytes of each word are exchanged" in done.out


def test_programs_without_mnemonics(cli: Cli) -> None:
    for name, seed in (("a.json", 1), ("b.json", 2)):
        save_backup(backup(program(400, seed=seed)), Path(name))
    assert "network" not in cli("diff", "a.json", "b.json").out
    assert cli("diff", "a.json", "b.json", "--json").document("diff")["networks"] is None
    project_file("c.pdw", IMAGE)
    done = cli("diff", "a.json", "c.pdw", "--json")
    assert done.code == 1
    assert done.document("diff")["networks"] is None


def test_standard_input_is_one_program(cli: Cli) -> None:
    done = cli("diff", "-", "-")
    assert (done.code, done.out) == (2, "")
    assert "standard input has one program" in done.err


def test_a_long_network_shows_what_is_near(cli: Cli) -> None:
    rest = [word for number in range(100) for word in ((0x10 + number) << 8 | 0x88,)]
    backup_file("a.json", image_of([0x0040, *rest, 0x00C1]))
    backup_file("b.json", image_of([0x0040, *rest[:50], 0x1498, *rest[51:], 0x00C1]))
    lines = cli("diff", "a.json", "b.json").out.splitlines()
    hunk = lines[lines.index("@@ N0000 changed @@") + 1 :]
    assert hunk == [
        " ...",
        *(f" AND M{number}" for number in (47, 48, 49)),
        "-AND M50",
        "+AND NOT M4",
        *(f" AND M{number}" for number in (51, 52, 53)),
        " ...",
    ]


def test_a_report_shows_the_networks(cli: Cli) -> None:
    backup_file("a.json", IMAGE)
    project_file("b.pdw", NEGATED)
    assert cli("diff", "a.json", "b.pdw", "--report", "x.html").code == 1
    page = Path("x.html").read_text("utf-8")
    assert "Networks that differ" in page
    assert "AND NOT X0" in page


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("name", ["press.json", "press.pdw"])
def test_verify(cli: Cli, swapped: bool, name: str) -> None:
    backup_file("press.json", IMAGE, swapped=swapped)
    project_file("press.pdw", IMAGE)
    with served(program_of(IMAGE, swapped=swapped)) as plc:
        done = cli("verify", name, "-p", plc.target)
        assert done.code == 0, done
        document = cli("verify", name, "-p", plc.target, "--json").document("verify")
        assert (document["same"], document["networks"]) == (True, [])
    with served(program_of(NEGATED, swapped=swapped)) as plc:
        done = cli("verify", name, "-p", plc.target, "--report", "x.html")
        assert done.code == 1, done
        assert done.out.splitlines()[-10:-1] == hunk(name, "PLC")
        document = cli("verify", name, "-p", plc.target, "--json").document("verify")
        assert [(each["change"], each["a"], each["b"]) for each in document["networks"]] == [
            ("changed", 0, 0)
        ]
    assert "Networks that differ" in Path("x.html").read_text("utf-8")


def test_verify_of_a_project_where_the_plc_has_another_family(cli: Cli) -> None:
    project_file("press.pdw", IMAGE)
    with served(program(400)) as plc:
        done = cli("verify", "press.pdw", "-p", plc.target, "--json")
        assert done.code == 1
        assert done.document("verify")["networks"] is None


def test_verify_of_a_small_model(cli: Cli) -> None:
    image = image_of(CODE, model=B1)
    project_file("press.pdw", image, B1)
    with served(program_of(image, pages=128)) as plc:
        done = cli("verify", "press.pdw", "-p", plc.target)
        assert (done.code, done.out.partition(":")[0]) == (0, "same")


def test_inspect(cli: Cli) -> None:
    project_file("press.pdw", IMAGE, elements=ELEMENTS)
    backup_file("press.json", IMAGE)
    out = cli("inspect", "press.pdw", "--raw", "press.bin").out
    assert "code      25 words in 6 networks, 2 unknown words" in out
    assert "comments  3 of elements, 0 of networks, cp1252" in out
    assert Path("press.bin").read_bytes() == IMAGE.image
    document = cli("inspect", "press.pdw", "--json").document("inspect")
    assert document["kind"] == "project"
    assert document["project"]["units"] == [{"name": "MAIN", "address": 512}]
    assert cli("inspect", "press.json", "--json").document("inspect")["kind"] == "backup"


def test_restore_takes_no_project(cli: Cli) -> None:
    project_file("press.pdw", IMAGE)
    done = cli("restore", "press.pdw", "-p", "sim:", "--yes")
    assert (done.code, done.out) == (2, "")
    assert "restore takes only backups" in done.err
    done = cli("history", "record", "press", "press.pdw", "--history", "books")
    assert done.code == 5
    assert "a WinProladder project, expected a backup of a PLC" in done.err
    assert not Path("books").exists()


def test_history(cli: Cli) -> None:
    both = image_of([*MAIN[:2], 0x0080, MAIN[3], 0x0740, 0x07C1, *MAIN[4:]], SUB)
    images = (IMAGE, both, image_of([*MAIN[:2], 0x0080, MAIN[3], 0x0740, 0x07C1, *MAIN[4:]], SUB, settings=3))
    for number, image in enumerate(images):
        path = backup_file(f"{number}.json", image)
        assert cli("history", "record", "press", path, "--history", "books").code == 0
    log = [
        line.partition("press: ")[2] for line in cli("history", "log", "--history", "books").out.splitlines()
    ]
    assert log == [
        "same code (2 words in 2 pages)",
        "N0000 changed, N0001 added (31 words in 3 pages)",
        "first backup",
    ]
    done = cli("history", "diff", "press", "~2", "~1", "--history", "books")
    assert done.code == 1
    assert "networks: N0000 changed, N0001 added" in done.out
    shown = cli("history", "show", "press@~1", "--history", "books")
    assert shown.out.splitlines()[-3:] == ["@@ N0001 added @@", "+ORG X7", "+OUT Y7"]
    document = cli("history", "show", "press@~1", "--history", "books", "--json").document("history-show")
    assert [each["change"] for each in document["networks"]] == ["changed", "added"]
    first = cli("history", "show", "press@~2", "--history", "books", "--json").document("history-show")
    assert first["networks"] is None


def test_check_says_which_networks(cli: Cli) -> None:
    project_file("press.pdw", IMAGE)
    with served(program_of(NEGATED)) as plc:
        plc.simulation.plcs[1].running = True
        done = cli("check", "--reference", "press.pdw", "-p", plc.target)
        assert done.code == 2, done
        assert "program DIFFERS from press.pdw: N0000 changed" in done.out


def test_backups_are_still_read_as_backups() -> None:
    data = Backup.parse(backup(program_of(IMAGE)).to_bytes()).to_bytes()
    assert data.startswith(b"{")
