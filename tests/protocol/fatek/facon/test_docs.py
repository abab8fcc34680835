"""docs/protocol-facon.md does not lie: examples decode to the words beside them, tables are the code's."""

from __future__ import annotations

import re
from dataclasses import dataclass

import pytest

from fatektool.errors import FrameError
from fatektool.protocol.commands import COMMAND_WORDS, Command
from fatektool.protocol.elements import KINDS, Element
from fatektool.protocol.explain import Explanation, FrameRole
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.protocol.fatek.facon.text import TEXT
from fatektool.protocol.plc_errors import MEANINGS
from fatektool.protocol.registry import new_explainer
from fatektool.protocol.status import MODELS, POINTS_FB, POINTS_FBS
from tests.protocol.decoding import decoded, one_frame, request_of
from tests.protocol.vectors import EXAMPLES, MISPRINTS, NAMES
from tests.root import DOCS

DOC = (DOCS / "protocol-facon.md").read_text("utf-8")
HEX = re.compile(r"[0-9A-F]{2}(?: [0-9A-F]{2})*")


@dataclass
class Shown:
    """A frame of the document and the words beside it."""

    kind: str
    raw: bytes
    words: str


def blocks(doc: str, language: str) -> list[tuple[str, list[Shown]]]:
    """Each block of frames, with the heading that it stands under."""
    found = []
    for section in re.split(r"^#+ ", doc, flags=re.MULTILINE)[1:]:
        heading, _, text = section.partition("\n")
        fenced = re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
        found += [(heading, frames_of(block)) for block in fenced]
    return found


def frames_of(block: str) -> list[Shown]:
    frames: list[Shown] = []
    for line in block.splitlines():
        kind, rest = line[:9].strip(), line[9:]
        if kind:
            assert kind in {"request", "answer", "wrong"}
            frames.append(Shown(kind, b"", ""))
        shown = frames[-1]
        if HEX.fullmatch(rest):
            assert not shown.words
            shown.raw += bytes.fromhex(rest)
        else:
            shown.words = f"{shown.words} {rest}".strip()
    return frames


def words(explanation: Explanation, before: int = 3) -> str:
    """The data field's meaning as the document writes it; ``before`` is how many fields stand before it."""
    return " · ".join(
        f"{field.name}: {field.meaning}" if field.meaning else field.name
        for field in explanation.fields[before:-2]
    )


def table(header: str, doc: str = DOC) -> list[list[str]]:
    """The rows of the table that begins with this header, marks of code and weight taken off."""
    lines = doc[doc.index(f"| {header} |") :].split("\n\n", maxsplit=1)[0].splitlines()
    return [[re.sub(r"[`*]", "", cell).strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


BLOCKS = blocks(DOC, "facon")


@pytest.mark.parametrize(("heading", "frames"), BLOCKS, ids=[f"{n} {b[0]}" for n, b in enumerate(BLOCKS)])
def test_examples(heading: str, frames: list[Shown]) -> None:
    explainer = new_explainer("facon")
    command = re.match(r"[0-9A-F]{2}(?= )", heading)
    for shown in frames:
        if shown.kind == "wrong":
            (error,) = decoded(shown.raw)
            assert isinstance(error, FrameError)
            assert error.checksum
            assert error.message == shown.words
            continue
        role = FrameRole.REQUEST if shown.kind == "request" else FrameRole.ANSWER
        (explanation,) = explainer.explain(shown.raw, role)
        assert (explanation.role, explanation.fault) == (role, None)
        assert words(explanation) == shown.words
        if command:
            assert explanation.command == int(command[0], 16)
    if [shown.kind for shown in frames] == ["request", "answer"] and "REFUSED" not in frames[1].words:
        request = request_of(one_frame(frames[0].raw))
        answer = FACON.parse_answer(request, one_frame(frames[1].raw))
        assert FACON.encode_answer(1, request, answer) == frames[1].raw


def test_every_example_and_misprint_of_the_paper_is_shown() -> None:
    shown = [frame.raw for _, frames in BLOCKS for frame in frames]
    for example in EXAMPLES:
        assert example.asks in shown
        assert example.answers in shown
    assert [frame.raw for _, frames in BLOCKS for frame in frames if frame.kind == "wrong"] == [
        misprint.raw for misprint in MISPRINTS
    ]
    assert len(NAMES) == 12


@pytest.mark.parametrize("command", Command, ids=lambda command: f"{command:02X}")
def test_every_command_has_a_section_with_an_example(command: Command) -> None:
    heading = f"{command:02X} {command.words}"
    assert f"\n### {heading}\n" in DOC
    kinds = [[shown.kind for shown in frames] for found, frames in BLOCKS if found == heading]
    assert ["request", "answer"] in kinds


def test_frames_in_the_running_text() -> None:
    inline = [bytes.fromhex(text) for text in re.findall(r"\b(02(?: [0-9A-F]{2})+ 03)`", DOC)]
    assert len(inline) >= 2
    for raw in inline:
        assert one_frame(raw).raw == raw


def test_sums() -> None:
    sums = re.findall(r"((?:[0-9A-F]{2} \+ )+[0-9A-F]{2}) = ([0-9A-F]+)$", DOC, re.MULTILINE)
    assert len(sums) == 2
    for terms, total in sums:
        assert sum(int(term, 16) for term in terms.split(" + ")) == int(total, 16)


def test_elements() -> None:
    rows = table("kind")
    assert {row[0] for row in rows} == set(KINDS)
    for symbol, _, bits, first, last, stride, step in rows:
        kind = KINDS[symbol]
        assert (kind.bits, kind.stride, kind.step) == (int(bits), int(stride), int(step))
        assert TEXT.element(Element(symbol, 0)).decode() == first
        assert TEXT.element(Element(symbol, kind.last)).decode() == last


def test_codes() -> None:
    assert [int(row[0], 16) for row in table("code | meaning")] == [0, *MEANINGS]
    assert {int(row[0], 16): row[1] for row in table("code | command")} == COMMAND_WORDS
    assert {int(row[0], 16): row[1] for row in table("byte 2")} == MODELS
    fb, fbs = (
        {code: int(points) for code, points in enumerate(row[1:]) if points.isdigit()}
        for row in table("code | 00")
    )
    assert (fb, fbs) == (POINTS_FB, POINTS_FBS)


def headings(doc: str) -> set[str]:
    """The anchors of a document."""
    return {
        re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        for heading in re.findall(r"^#+ (.*)$", doc, re.MULTILINE)
    }


@pytest.mark.parametrize("name", ["protocol-facon.md", "protocol-mseries.md"])
def test_links_lead_somewhere(name: str) -> None:
    doc = (DOCS / name).read_text("utf-8")
    for page, anchor in re.findall(r"\]\(([\w.-]*)#([^)]*)\)", doc):
        assert anchor in headings((DOCS / page).read_text("utf-8") if page else doc)
    for page in re.findall(r"\]\(([\w.-]+)\)", doc):
        assert (DOCS / page).exists()
