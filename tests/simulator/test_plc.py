"""Models, memory and the demonstration program, without a protocol."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.simulator.build import build_plcs
from fatektool.simulator.elements import KINDS, SymbolKind
from fatektool.simulator.memory import DiscreteAction
from fatektool.simulator.models import MODELS
from fatektool.simulator.plc import SimulatedPlc
from fatektool.simulator.program import demonstration
from fatektool.simulator.program.demonstration import program_of
from fatektool.simulator.program.facon_program import demonstration_program, header_page
from fatektool.simulator.refusal import Refusal, RefusalCode

if TYPE_CHECKING:
    from collections.abc import Callable


def test_the_model_read_from_an_fbs() -> None:
    plc = SimulatedPlc(model=MODELS["fbs-20mc"])
    plc.running = plc.id_set = True
    known = "21 01 02 40 8000 0100 0100 0064 0064 07D2 03E8 0000 1F88 1000 0100 0100"
    assert plc.detailed_status() == bytes.fromhex(known).ljust(64, b"\0")
    plc.id_set = False
    assert plc.brief_status() == bytes.fromhex("01 40 00")


def test_models_are_of_every_class_of_the_brief_status() -> None:
    assert {model.status2 for model in MODELS.values()} == {0xFF, 0x53, 0x54, 0x55, 0x56, 0x40}
    assert all(name == model.name == name.lower() for name, model in MODELS.items())


@pytest.mark.parametrize(
    ("words", "pages"), [(1, 2), (64, 2), (65, 3), (8192, 129), (13184, 207), (65535, 1025)]
)
def test_page_count(words: int, pages: int) -> None:
    model = replace(MODELS["fbe-28mc"], ladder_words=words)
    assert model.page_count == pages
    program = demonstration_program(words)
    assert len(program) == pages
    assert {len(page) for page in program} == {128}
    assert program[0] == b"FB30" + words.to_bytes(2, "big") + b"\xff" * 122


def test_no_ladder_of_no_or_too_many_words() -> None:
    for words in (0, 65536):
        with pytest.raises(ValueError, match="65535"):
            replace(MODELS["fbe-28mc"], ladder_words=words)
        with pytest.raises(ValueError, match="65535"):
            demonstration_program(words)


def test_demonstration_program_is_plausible_and_repeatable() -> None:
    program = demonstration_program(13184)
    assert program == demonstration_program(13184)
    assert program != demonstration_program(13184, seed=2)
    used = [page for page in program if page != b"\xff" * 128]
    assert len(set(used)) == len(used) == 156
    assert program[-1] == b"\xff" * 128
    assert header_page(100, signature="FM", digits="12")[:6] == b"FM12\x00\x64"
    with pytest.raises(ValueError, match="FX30"):
        header_page(100, signature="FX")


def test_a_program_is_made_once_and_nobody_changes_that_of_another(monkeypatch: pytest.MonkeyPatch) -> None:
    first = build_plcs(ladder_words=200, program_seed=9)[1]
    kept = list(first.pages)
    monkeypatch.setattr(demonstration, "demonstration_program", lambda *_, **__: pytest.fail("made again"))
    first.write_page(1, bytes(128))
    program_of(first.model, seed=9)[2] = b""
    second = build_plcs(ladder_words=200, program_seed=9)[1]
    assert list(second.pages) == kept != list(first.pages)


def test_a_plc_is_made_of_what_fits() -> None:
    with pytest.raises(ValueError, match="254"):
        SimulatedPlc(255)
    with pytest.raises(ValueError, match="207 pages"):
        SimulatedPlc(pages=[b""])


def test_enabled_x_follows_its_terminal() -> None:
    plc = SimulatedPlc()
    plc.set_input(5, 1)
    plc.write_discretes("X", 5, b"\x00")
    plc.write_words("WX", 0, [0])
    plc.control_discrete(DiscreteAction.RESET, "X", 5)
    assert plc.read_discretes("X", 5, 1) == b"\x01"
    plc.control_discrete(DiscreteAction.DISABLE, "X", 5)
    assert plc.read_discretes("X", 5, 1) == b"\x01"
    plc.control_discrete(DiscreteAction.RESET, "X", 5)
    plc.write_discretes("X", 5, b"\x01")
    plc.set_input(5, 1)
    assert plc.read_discretes("X", 5, 1) == b"\x00"
    plc.control_discrete(DiscreteAction.ENABLE, "X", 5)
    assert plc.read_discretes("X", 5, 1) == b"\x01"


def test_disabled_discretes_keep_their_state_in_packed_writes() -> None:
    plc = SimulatedPlc()
    plc.control_discrete(DiscreteAction.DISABLE, "Y", 9)
    plc.write_words("WY", 8, [0xFFFF])
    assert plc.read_words("WY", 8, 1) == [0xFFFD]
    plc.write_mixed([("Y", 9, 1), ("Y", 10, 0)])
    assert plc.read_words("WY", 8, 1) == [0xFFF9]


def test_input_registers_do_not_take() -> None:
    plc = SimulatedPlc()
    plc.write_words("R", 3839, [1, 2])
    plc.write_words("DR", 3903, [0x00050004])
    assert plc.read_words("R", 3839, 2) == [1, 0]
    assert plc.read_words("R", 3903, 2) == [0, 5]
    plc.set_input_register(3840, 77)
    assert plc.read_words("R", 3840, 1) == [77]


def test_refusals_of_the_operations() -> None:
    plc = SimulatedPlc()
    for symbol in ("Q", "WX", "R"):
        with pytest.raises(Refusal) as refused:
            plc.read_discretes(symbol, 0, 1)
        assert refused.value.code == RefusalCode.ILLEGAL_FORMAT
    with pytest.raises(Refusal, match="code 4"):
        plc.write_page(0, b"short")
    with pytest.raises(Refusal, match="code A"):
        plc.read_words("R", -1, 1)


def test_acknowledge_only_checks_and_makes_nothing() -> None:
    plc = SimulatedPlc()
    plc.acknowledge_only = True
    plc.write_discretes("Y", 0, b"\x01")
    plc.control_discrete(DiscreteAction.SET, "Y", 1)
    plc.write_words("R", 0, [1])
    plc.write_mixed([("R", 1, 1)])
    plc.write_page(0, bytes(128))
    assert plc.revision == 0
    writes: list[Callable[[], object]] = [
        lambda: plc.write_words("R", 8072, [1]),
        lambda: plc.write_mixed([("Y", 256, 1)]),
        lambda: plc.control_discrete(DiscreteAction.SET, "Y", 256),
        lambda: plc.write_page(207, bytes(128)),
    ]
    for write in writes:
        with pytest.raises(Refusal, match="code A"):
            write()


def test_revision_grows_with_every_change() -> None:
    plc = SimulatedPlc()
    seen = [plc.revision]
    changes: list[Callable[[], object]] = [
        lambda: setattr(plc, "battery_low", True),
        lambda: plc.write_words("R", 0, [1]),
        lambda: plc.write_discretes("M", 0, b"\x01"),
        lambda: plc.control_discrete(DiscreteAction.DISABLE, "M", 0),
        lambda: plc.write_page(3, bytes(128)),
        lambda: plc.set_input(0, 1),
        lambda: plc.set_input_register(0, 1),
        plc.run,
        plc.stop,
    ]
    for change in changes:
        change()
        seen.append(plc.revision)
    assert seen == sorted(set(seen))
    plc.stop()
    plc.read_words("R", 0, 1)
    assert plc.revision == seen[-1]


WORDS = [kind for kind in KINDS.values() if kind.bits > 1 and kind.area not in ("X", "F")]


@given(st.sampled_from(WORDS), st.data())
def test_words_read_back_as_written(kind: SymbolKind, data: st.DataObject) -> None:
    plc = SimulatedPlc(pages=PAGES)
    values = data.draw(st.lists(st.integers(0, (1 << kind.bits) - 1), min_size=1, max_size=5))
    address = data.draw(st.integers(0, 10)) * (8 if kind.packed else 1)
    plc.write_words(kind.symbol, address, values)
    assert plc.read_words(kind.symbol, address, len(values)) == values
    if kind.packed:
        bits = plc.read_discretes(kind.area, address, kind.bits)
        assert sum(bit << position for position, bit in enumerate(bits)) == values[0]


PAGES = SimulatedPlc().pages
