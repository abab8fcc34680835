"""Who reads and who writes, and what is odd."""

from __future__ import annotations

from fatektool.ladder.cross_reference import CrossReference, InstructionPlace
from fatektool.ladder.networks import Code

CODE = [
    *(0x0040, 0x10A8, 0x00C1),  # ORG X0, OR M0, OUT Y0
    *(0x1048, 0xADF7, 0x0000, 0x0500, 0x140A),  # ORG M0, FUN 08D MOV S:5 D:R10
    *(0x0140, 0xACF4, 0x160A, 0x0209),  # ORG X1, FUN 08 MOV S:R11 D:WM0
    *(0x2048, 0x80FD, 0x0A00, 0xCC03, 0xFC6F, 0x00C1),  # ORG M16, T30 .01 10, FO 0, OUT Y0
    *(0x1E42, 0x82FC, 0x3008),  # ORG T30, SET( ) M32
    *(0x0240, 0x1AF5, 0x6013, 0xB813),  # ORG X2, FUN 140 HSPSO SR:R1200 WR:R1244
    *(0x0340, 0xACF5, 0x0100, 0x6213),  # ORG X3, FUN 08 MOV S:1 D:R1201: in the table
    *(0x904F, 0x01C1),  # ORG M1920, OUT Y1
]


def reference(words: list[int]) -> CrossReference:
    return CrossReference(Code.of(words))


def odd(words: list[int]) -> list[tuple[str, str]]:
    return [(found.kind.value, found.element) for found in reference(words).findings()]


def test_uses() -> None:
    found = reference(CODE)
    assert found.uses("X0").reads == [InstructionPlace(0, 0)]
    assert found.uses("Y0").writes == [InstructionPlace(0, 2), InstructionPlace(3, 10)]
    assert (found.uses("T30").reads, found.uses("T30").writes) == (
        [InstructionPlace(4, 11)],
        [InstructionPlace(3, 8)],
    )


def test_memory_counts_not_the_name() -> None:
    found = reference(CODE)
    assert found.uses("R11").writes == [InstructionPlace(1, 4)]  # through R10 of 32 bits
    assert found.uses("M5").writes == [InstructionPlace(2, 6)]  # through WM0
    assert found.uses("WM0").reads == [InstructionPlace(0, 1), InstructionPlace(1, 3)]  # M0
    assert found.uses("M16").writes == []
    assert found.uses("DR10").reads == [InstructionPlace(2, 6)]


def test_what_is_odd() -> None:
    assert odd(CODE) == [
        ("double-coil", "Y0"),
        ("never-read", "M32"),
        ("never-written", "M16"),
        ("never-written", "R1200"),
    ]


def test_a_register_behind_a_pointer_may_be_any() -> None:
    write = [0x0040, 0xACF5, 0x0100, 0x140A]  # R10, which nothing reads
    assert odd(write) == [("never-read", "R10")]
    read_by_pointer = [0x0040, 0xACF4, 0x008A, 0x0040]  # FUN 08 MOV S:R0V D:D0
    assert odd(write + read_by_pointer) == [("never-read", "D0")]


def test_a_label_without_characters() -> None:
    assert odd([0x00EF, 0, 0, 0, 0x0040, 0x00C1]) == []


def test_elements_are_in_order() -> None:
    assert reference(CODE).elements[:4] == ["M0", "M16", "M32", "M1920"]
