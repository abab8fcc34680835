"""Every instruction that the vendor's program is known to have printed, and those read from use."""

from __future__ import annotations

from fatektool.ladder.decode import decode, encode
from fatektool.ladder.grades import Grade
from fatektool.ladder.networks import Code
from fatektool.ladder.table import FORMS
from tests.ladder.vectors import PRINTED, READ, Vector
from tests.rows import each


@each("vector", PRINTED, ids=lambda vector: vector.text)
def test_the_vendors_print(vector: Vector) -> None:
    (found,) = decode(vector.words)
    assert (found.text, found.grade, found.known) == (vector.text, Grade.A, True)
    assert encode([found]) == vector.words


@each("vector", READ, ids=lambda vector: vector.text)
def test_what_is_read_from_use(vector: Vector) -> None:
    (found,) = decode(vector.words)
    assert found.text.removeprefix("~") == vector.text
    assert found.text.startswith("~") == (found.grade is not Grade.A)
    assert encode([found]) == vector.words


def test_all_of_them_in_a_row() -> None:
    words = [word for vector in PRINTED for word in vector.words]
    assert [found.text for found in decode(words)] == [vector.text for vector in PRINTED]
    assert encode(Code.of(words).instructions) == tuple(words)


def test_no_word_is_the_head_of_two_forms() -> None:
    for number, one in enumerate(FORMS):
        for other in FORMS[number + 1 :]:
            heads = zip(one.fixed, other.fixed, one.free, other.free, strict=False)
            assert any((a ^ b) & ~(x | y) for a, b, x, y in heads), (one.text, other.text)


def test_there_are_enough_vectors() -> None:
    assert len(PRINTED) > 300
    assert len(READ) > 80


@each(
    ("words", "text"),
    [
        ((0x0AF5,), "?? 0AF5"),
        ((0x1AF5, 0x2814), "?? 1AF5 2814"),  # cut short by the end of the code
        ((0x00E0,), "?? 00E0"),
        ((0x00E0, 0x00C1), "?? 00E0|OUT Y0"),  # an edge of a coil there is not
        ((0x0020, 0x00C1), "?? 0020|OUT Y0"),
        ((0xFF8F,), "?? FF8F"),
        ((0xFC8F, 0x00C1), "?? FC8F|OUT Y0"),
        # D200 and D201 look like ORG Y144 and ORG Y146, which nothing could follow.
        ((0x3FF4, 0x9041, 0x9241, 0x0040, 0x00C1), "?? 3FF4 9041 9241|ORG X0|OUT Y0"),
        ((0x3FF4, 0x9041, 0xFC6F, 0x00C1, 0xEB5F), "?? 3FF4 9041 FC6F 00C1|ORG OPEN"),
        ((0x3FF4, 0x1234, 0x0040, 0x3FF4, 0x0040, 0x00C1), "?? 3FF4 1234|ORG X0|?? 3FF4|ORG X0|OUT Y0"),
        # D200 and 5, R10, R3000, -1, or 36.0: none is ORG Y144 or ORG T16 with a coil, or with nothing known.
        ((0x3FF4, 0x9041, 0x0500, 0x0140, 0x00C1), "?? 3FF4 9041 0500|ORG X1|OUT Y0"),
        ((0x3FF4, 0x9041, 0x140A, 0x0140, 0x00C1), "?? 3FF4 9041 140A|ORG X1|OUT Y0"),
        ((0x3FF4, 0x9041, 0x7021, 0x0140, 0x00C1), "?? 3FF4 9041 7021|ORG X1|OUT Y0"),
        ((0x3FF4, 0x9041, 0xFFFF, 0x0140, 0x00C1), "?? 3FF4 9041 FFFF|ORG X1|OUT Y0"),
        ((0x3FF4, 0x1042, 0x0000, 0x0140, 0x00C1), "?? 3FF4 1042 0000|ORG X1|OUT Y0"),
        ((0x3FF4, 0x9041, 0x0064, 0x00C1, 0x0140, 0x00C1), "?? 3FF4 9041 0064 00C1|ORG X1|OUT Y0"),
        # An odd address is no register, and D1032, which M0 would be, is seldom used.
        ((0x3FF4, 0x140A, 0x0140, 0x0811), "?? 3FF4 140A|ORG X1|OUTS Y8"),
        ((0x3FF4, 0x140A, 0x1048, 0x1118), "?? 3FF4 140A|ORG M0|OUTS M1"),
        ((0x3FF4, 0x140A, 0x0240, 0x84EE, 0x00C1), "?? 3FF4 140A|ORG X2|?? 84EE|OUT Y0"),
        ((0x1BEF, 0xFFFF, 0x002A, 0x0000), "~FUN 65 LBL \\x1B\\x1FF\\x7FT"),
        ((0x84EE, 0x00C1), "?? 84EE|OUT Y0"),
        ((0x81EE, 0x0040), "|ORG X0"),
        ((0x00E0, 0xE68F, 0x00E0, 0xE69F), "~AND TU SHORT|~AND TD OPEN"),
        ((0xE6CF, 0xE6DF), "OUT SHORT|~OUT OPEN"),
        ((0x80FC, 0x100A, 0x0060), "~@6000 .01 R8"),
        ((0xACF5, 0xFF7F, 0x000A), "FUN 08 MOV S:32767 D:R0"),
        ((0xACF5, 0x5AA5, 0x000A), "~FUN 08 MOV S:A55AH D:R0"),
        ((0xD0F2, 0x6013), "~FUN 141 MPARA Ps:2 SR:R1200"),
        ((0x1AF7, 0x6013, 0xB813), "~FUN 140 HSPSO Ps:3 SR:R1200 WR:R1244"),
        ((0x7FF5, 0x0500, 0x807F, 0, 0x000A, 0, 0x040A), "~FUN 205 FDIV Sa:7F800000H Sb:@0A000000 D:R2"),
    ],
)
def test_what_no_vector_has(words: tuple[int, ...], text: str) -> None:
    found = decode(words)
    assert "|".join(instruction.text for instruction in found) == text
    assert encode(found) == words
