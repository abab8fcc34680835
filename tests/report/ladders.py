"""Two programs of an FBs, and their reports with the ladders drawn."""

from __future__ import annotations

from dataclasses import replace

from fatektool.cli.programs.documents import listing_document, program_differences
from fatektool.project.comparison import ProgramComparison, compare_programs
from fatektool.project.program_file import NO_COMMENTS, ProgramFile
from fatektool.report.listing import listing_report
from fatektool.report.program import diff_report
from tests.cli.running import check
from tests.ladder.circuits import words_of
from tests.project.files import program_of
from tests.project.images import image_of

TIME = "2026-11-22T03:15:00Z"
COMMENTS = {"X0": "Start pompy", "M3": "Zawór główny", "M1": "水泵启动按钮", "R1300": "<b>&tabela"}
SERVO = "LD OPEN, LD OPEN, FUN 140 HSPSO Ps:1 SR:R1300 WR:R1500, FO 0, OUT M460"
LONG = ", ".join(["ORG X0", *["AND M3"] * 12, "OUT Y0", "OUT M0"])
SAME = [f"ORG S10, {SERVO}, FO 2, OUT M461", LONG, "ORG OPEN", "STP S20, OUT Y0, AND X3, TO S20"]
GONE, CAME = "ORG M1, OUTS M1", "ORG X1, OR M0, OUT M401"
BEFORE, AFTER = "ORG X0, OR Y0, AND M3, TU, OUT Y2", "ORG X0, OR Y0, AND NOT M3, TU, OUT Y2"
FIRST, SECOND = [GONE, *SAME, BEFORE], [*SAME, CAME, AFTER]


def words(networks: list[str]) -> list[int]:
    return [word for network in networks for word in words_of(*network.split(", "))]


A = program_of(image_of([*words(FIRST), 0x0240, 0x3FF4, 0x9041]))
B = program_of(image_of([*words(SECOND), 0x0240, 0x3FF4, 0x9041]))


def listing() -> str:
    found = ProgramFile("press.json", A)
    comments = replace(NO_COMMENTS, elements=COMMENTS)
    document = listing_document(found, found.networks, comments)
    check(document, "listing")
    return listing_report(document, found.networks, time=TIME)


def comparison() -> ProgramComparison:
    return compare_programs(A, B)


def ladder_diff() -> str:
    found = comparison()
    document = {
        "schema": "fatektool.diff/1",
        "a": {"file": "monday.json", "sha256": A.sha256},
        "b": {"file": "tuesday.json", "sha256": B.sha256},
        **program_differences(found),
    }
    check(document, "diff")
    return diff_report(document, A, B, time=TIME, changes=found.networks or (), comments=COMMENTS)
