"""``xref`` as a command."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.project.files import ELEMENTS, IMAGE, backup_file, project_file

if TYPE_CHECKING:
    from tests.cli.running import Cli


def test_some_elements(cli: Cli) -> None:
    backup_file("press.json", IMAGE)
    project_file("press.pdw", IMAGE, elements=ELEMENTS)
    done = cli("xref", "press.json", "r8", "Y0", "M99", "--comments", "press.pdw")
    assert done.code == 0
    assert done.out.splitlines() == [
        "R8  TIME",
        "  writes  N0001  0005  FUN 08 MOV S:5 D:R8",
        "  reads   N0002  0007  T30 .01 R8",
        "Y0  MOTOR",
        "  writes  N0000  0003  OUT Y0",
        "  writes  N0003  0012  OUT Y0",
        "M99",
        "  not in the program",
        "",
        "Y0 has an OUT in several places: the last one wins: N0000, N0003",
    ]


def test_all_of_it_as_json(cli: Cli) -> None:
    project_file("press.pdw", IMAGE, elements=ELEMENTS)
    document = cli("xref", "press.pdw", "--json").document("xref")
    assert document["elements"]["R8"] == {
        "reads": [{"network": 2, "instruction": 7}],
        "writes": [{"network": 1, "instruction": 5}],
        "comment": "TIME",
    }
    assert list(document["elements"]) == ["M0", "R8", "T30", "X0", "X1", "X2", "Y0"]
    assert document["findings"] == [
        {
            "kind": "double-coil",
            "element": "Y0",
            "where": [{"network": 0, "instruction": 3}, {"network": 3, "instruction": 12}],
        }
    ]
    assert document["unknown_words"] == 2


def test_no_element(cli: Cli) -> None:
    backup_file("press.json", IMAGE)
    done = cli("xref", "press.json", "Q1")
    assert done.code == 2
    assert "no element 'Q1' of a program" in done.err
