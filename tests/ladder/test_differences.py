"""Networks against networks, matched as git matches lines."""

from __future__ import annotations

import random
from itertools import pairwise
from typing import TYPE_CHECKING

from hypothesis import given
from hypothesis import strategies as st

from fatektool.ladder.alignment import align
from fatektool.ladder.differences import compare_code, summary
from fatektool.ladder.networks import Code

if TYPE_CHECKING:
    from fatektool.ladder.differences import NetworkChange

ITEMS = st.lists(st.integers(0, 5), max_size=30) | st.lists(st.integers(0, 100), max_size=30)


def network(number: int) -> list[int]:
    """ORG Xn, AND Mn, AND M421, OUT Yn."""
    return [0x0040 | number << 8, 0x1088 | number << 8, 0xB589, 0x00C1 | number << 8]


def code(*networks: list[int]) -> Code:
    return Code.of([word for each in networks for word in each])


def shown(changes: tuple[NetworkChange, ...]) -> list[tuple[str, int | None, int | None]]:
    return [
        (each.change.value, each.a.number if each.a else None, each.b.number if each.b else None)
        for each in changes
    ]


MANY = [network(number) for number in range(100)]


def test_the_same() -> None:
    assert compare_code(code(*MANY), code(*MANY)) == ()
    assert summary(()) == ""


def test_a_contact_negated_is_one_line_in_one_network() -> None:
    changed = [*MANY[7][:2], 0xB599, MANY[7][3]]
    (found,) = compare_code(code(*MANY), code(*MANY[:7], changed, *MANY[8:]))
    assert found.lines == (" ORG X7", " AND M7", "-AND M421", "+AND NOT M421", " OUT Y7")
    assert shown((found,)) == [("changed", 7, 7)]
    assert summary((found,)) == "N0007 changed"


def test_a_network_put_in_is_one_addition() -> None:
    found = compare_code(code(*MANY), code(*MANY[:50], network(200), *MANY[50:]))
    assert shown(found) == [("added", None, 50)]
    assert found[0].lines == ("+ORG X200", "+AND M200", "+AND M421", "+OUT Y200")
    assert shown(compare_code(code(*MANY[:50], network(200), *MANY[50:]), code(*MANY))) == [
        ("removed", 50, None)
    ]


def test_one_put_in_beside_one_that_changed() -> None:
    changed = [*MANY[50][:2], 0xB599, MANY[50][3]]
    found = compare_code(code(*MANY), code(*MANY[:50], network(200), changed, *MANY[51:]))
    assert shown(found) == [("added", None, 50), ("changed", 50, 51)]
    assert summary(found) == "N0050 added, N0051 changed"


def test_one_put_in_where_all_others_changed() -> None:
    """An element that is used everywhere was exchanged, and a network was put in among them."""
    old = [network(number) for number in range(250)]
    new = [[*each[:2], 0xB689, each[3]] for each in old]
    found = compare_code(code(*old), code(*new[:100], [0x0042, 0x00C2], *new[100:]))
    assert [each for each in shown(found) if each[0] != "changed"] == [("added", None, 100)]
    assert len(found) == 251


def test_of_too_many_to_match_none_is_named_that_did_not_change() -> None:
    here, there, other = [0x0040, 0x00C1], [0x0140, 0x02C1], [0x0240, 0x03C1]
    old = Code.of(here * 2000, other * 2000)
    new = Code.of([*here, *there] * 500, [*here, *there] * 500)
    found = compare_code(old, new)
    for each in found:
        assert each.a is None or each.b is None or each.a.unit == each.b.unit
        assert any(line.sign != " " for line in each.diff)


def test_another_program_altogether() -> None:
    found = compare_code(code([0x0040, 0x00C1]), code([0x1448, 0x82FC, 0x3204]))
    assert shown(found) == [("added", None, 0), ("removed", 0, None)] or shown(found) == [
        ("removed", 0, None),
        ("added", None, 0),
    ]


def test_what_is_drawn_in_another_way_is_shown_by_its_words() -> None:
    (found,) = compare_code(code([0x0040, 0x0160, 0x23E4, 0x00C1]), code([0x0040, 0x0160, 0x24E4, 0x00C1]))
    assert found.lines == (" ORG X0", " LD X1", "-ORLD (23E4)", "+ORLD (24E4)", " OUT Y0")
    (found,) = compare_code(code([0x0040, 0x81EE, 0x00C1]), code([0x0040, 0x82EE, 0x00C1]))
    assert found.lines == (" ORG X0", "-(drawing 81EE)", "+(drawing 82EE)", " OUT Y0")


def test_a_network_in_the_other_unit_is_another() -> None:
    main, both = Code.of(MANY[1] + MANY[2]), Code.of(MANY[1], MANY[2])
    assert {each.change.value for each in compare_code(main, both)} == {"added", "removed"}


def test_summary_of_many() -> None:
    found = compare_code(code(), code(*MANY))
    assert summary(found, 2) == "N0000 added, N0001 added, 98 networks more"


@given(ITEMS, ITEMS)
def test_alignment_is_both(a: list[int], b: list[int]) -> None:
    blocks = align(a, b)
    assert [item for block in blocks for item in a[block.a_first : block.a_end]] == a
    assert [item for block in blocks for item in b[block.b_first : block.b_end]] == b
    for block in blocks:
        assert block.a_end > block.a_first or block.b_end > block.b_first
        if block.equal:
            assert a[block.a_first : block.a_end] == b[block.b_first : block.b_end]
    assert all(one.equal != two.equal for one, two in pairwise(blocks))
    assert bool(a != b) == any(not block.equal for block in blocks)


def test_alignment_of_much_that_is_alike() -> None:
    noise = random.Random(1)  # noqa: S311  # a fixed seed
    a, b = [noise.randrange(3) for _ in range(10000)], [noise.randrange(3) for _ in range(10000)]
    blocks = align(a, b)
    assert [item for block in blocks for item in a[block.a_first : block.a_end]] == a


def test_alignment_of_what_nests_deep() -> None:
    """Each item stands once only where the one before was taken out."""
    depth = 3000
    a = [*range(depth), *reversed(range(depth))]
    b = [item + 1 for item in a]
    blocks = align(a, b)
    assert [item for block in blocks for item in b[block.b_first : block.b_end]] == b


def test_a_memory_of_one_word_networks() -> None:
    a, b = Code.of([0xEB5F, 0xE25F] * 10000), Code.of([0xE25F] * 20000)
    assert len(compare_code(a, b)) >= 10000
