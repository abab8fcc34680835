"""Random reads, writes and forces, through client and simulator, against a dict."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fatektool.errors import LineError
from fatektool.jobs.elements.disabled import read_disabled
from fatektool.jobs.elements.reads import read_elements
from fatektool.jobs.elements.writes import write_elements
from fatektool.protocol.elements import KINDS, Element
from tests.night import examples
from tests.plant import small

if TYPE_CHECKING:
    from collections.abc import Callable

SIZES: Final = {
    "X": 256, "Y": 256, "M": 2002, "S": 1000, "T": 256, "C": 256,
    "R": 8072, "D": 4096, "F": 8192, "RT": 256, "RC": 256,
}  # fmt: skip
READ_ONLY: Final = range(3840, 3904)

Place = tuple[str, int]


def places(element: Element) -> list[Place]:
    """The bits or registers of an element: spelled out, not asked of the code under test."""
    symbol, at = element.symbol, element.address
    for prefix, count in (("DW", 32), ("W", 16)):
        if symbol.startswith(prefix):
            return [(symbol.removeprefix(prefix), at + bit) for bit in range(count)]
    if symbol in SIZES:
        return [(symbol, at)]
    return [(symbol.removeprefix("D"), at), (symbol.removeprefix("D"), at + 1)]


def width(element: Element) -> int:
    return element.kind.bits // len(places(element))


@dataclass
class Model:
    """What a PLC holds, as a dict."""

    cells: dict[Place, int] = field(default_factory=dict)
    disabled: set[Place] = field(default_factory=set)
    terminals: dict[int, int] = field(default_factory=dict)

    def has(self, element: Element) -> bool:
        return all(at < SIZES[symbol] for symbol, at in places(element))

    def value(self, element: Element) -> int:
        parts = enumerate(places(element))
        return sum(self.cells.get(place, 0) << number * width(element) for number, place in parts)

    def write(self, element: Element, value: int) -> None:
        if not self.has(element):
            return
        for number, place in enumerate(places(element)):
            symbol, at = place
            held = place in self.disabled or symbol == "X" or (symbol == "R" and at in READ_ONLY)
            if not held:
                self.cells[place] = value >> number * width(element) & ((1 << width(element)) - 1)

    def control(self, name: str, element: Element) -> None:
        (place,) = places(element)
        if name == "disable":
            self.disabled.add(place)
        elif name == "enable":
            self.disabled.discard(place)
            if element.symbol == "X":
                self.cells[place] = self.terminals.get(element.address, 0)
        elif element.symbol != "X" or place in self.disabled:
            self.cells[place] = int(name == "set")

    def terminal(self, at: int, value: int) -> None:
        self.terminals[at] = value
        if ("X", at) not in self.disabled:
            self.cells["X", at] = value


@st.composite
def elements(draw: st.DrawFn, symbols: tuple[str, ...] = tuple(KINDS)) -> Element:
    """Near the beginning, the end, and the read-only registers, where they meet each other."""
    kind = KINDS[draw(st.sampled_from(symbols))]
    area = places(Element(kind.symbol, 0))[0][0]
    middle = draw(st.sampled_from([8, SIZES[area], 3840 if area == "R" else 32]))
    at = max(0, middle + draw(st.integers(-24, 12)))
    return Element(kind.symbol, min(at, kind.last) // kind.step * kind.step)


@st.composite
def runs(draw: st.DrawFn) -> list[Element]:
    """A range of one kind."""
    first = draw(elements())
    most = (first.kind.last - first.address) // first.kind.stride + 1
    return [first.after(place) for place in range(draw(st.integers(1, min(most, 40))))]


DISCRETES = elements(tuple("XYMSTC"))
SELECTIONS = st.lists(elements(), min_size=1, max_size=12) | runs()
STEPS = st.one_of(
    st.tuples(st.just("read"), SELECTIONS),
    st.tuples(st.just("write"), SELECTIONS, st.integers(0, 2**32 - 1)),
    st.tuples(st.sampled_from(["disable", "enable", "set", "reset"]), DISCRETES),
    st.tuples(st.just("terminal"), st.integers(0, 40), st.integers(0, 1)),
)


def apart(wanted: list[Element]) -> list[Element]:
    """Those that share nothing with the ones before them."""
    taken: set[Place] = set()
    found = []
    for element in wanted:
        if taken.isdisjoint(places(element)):
            taken.update(places(element))
            found.append(element)
    return found


@settings(max_examples=examples(120), deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(STEPS, min_size=1, max_size=12))
def test_client_and_simulator_agree_with_a_dict(steps: list[tuple[object, ...]]) -> None:
    made = small(model="fbs-20mc")
    model = Model()
    touched: list[Element] = []

    def read(wanted: list[Element]) -> None:
        reading = read_elements(made.plc, wanted)
        assert reading.values == {each: model.value(each) for each in wanted if model.has(each)}
        assert set(reading.errors) == {each for each in wanted if not model.has(each)}

    def write(wanted: list[Element], seed: int) -> None:
        items = [
            (each, (seed * (2 * number + 1) >> number % 7) & ((1 << each.kind.bits) - 1))
            for number, each in enumerate(apart(wanted))
        ]
        failed = write_elements(made.plc, items)
        for each, value in items:
            model.write(each, value)
        expected = {each for each, value in items if not model.has(each) or model.value(each) != value}
        assert {each.element for each in failed} == expected
        for left in failed:
            assert left.got == (model.value(left.element) if model.has(left.element) else None)
            assert left.reason

    def control(name: str) -> Callable[[Element], None]:
        def do(element: Element) -> None:
            if model.has(element):
                getattr(made.plc, name)(element)
                model.control(name, element)

        return do

    def terminal(at: int, value: int) -> None:
        made.device.set_input(at, value)
        model.terminal(at, value)

    doing: dict[object, Callable[..., None]] = {"read": read, "write": write, "terminal": terminal}
    doing |= {name: control(name) for name in ("disable", "enable", "set", "reset")}
    for name, *rest in steps:
        doing[name](*rest)
        touched += [each for part in rest for each in (part if isinstance(part, list) else [part])
                    if isinstance(each, Element)]  # fmt: skip
    read(touched)
    discretes = [each for each in touched if each.kind.bits == 1]
    flags, errors = read_disabled(made.plc, discretes)
    assert flags == {each: places(each)[0] in model.disabled for each in discretes if model.has(each)}
    assert set(errors.errors) == {each for each in discretes if not model.has(each)}


@settings(max_examples=examples(40), deadline=None)
@given(
    st.lists(elements(("R", "DR", "M", "WM", "DWM", "X")), min_size=1, max_size=40),
    st.sets(st.integers(0, 8100)),
    st.sampled_from(["drop=0.1", "flip=0.1", "duplicate=0.1", "late=0.1", "echo=1"]),
    st.integers(0, 1000),
)
def test_a_bad_line_changes_nothing(wanted: list[Element], filled: set[int], fault: str, seed: int) -> None:
    made = small(model="fbs-20mc", faults=[fault], seed=seed)
    model = Model()
    for at in filled:
        if at < SIZES["R"]:
            made.device.set_input_register(at, at)
            model.cells["R", at] = at
    try:
        reading = read_elements(made.plc, wanted)
    except LineError:
        return
    assert reading.values == {each: model.value(each) for each in wanted if model.has(each)}
    assert set(reading.errors) == {each for each in wanted if not model.has(each)}
