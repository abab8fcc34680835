"""Any valid request, any answer that matches it, and streams cut anywhere."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from hypothesis import strategies as st

from fatektool.protocol.commands import (
    MAX_DISCRETES,
    MAX_LOOPBACK,
    MAX_MIXED_WRITE_WORDS,
    MAX_READ_WORDS,
    PAGE_BYTES,
    Command,
    Control,
    ControlDiscrete,
    Loopback,
    ReadBriefStatus,
    ReadDetailedStatus,
    ReadDisabled,
    ReadDiscretes,
    ReadMixed,
    ReadPage,
    ReadRegisters,
    Request,
    RunStop,
    WriteDiscretes,
    WriteMixed,
    WritePage,
    WriteRegisters,
)
from fatektool.protocol.elements import KINDS, Element
from fatektool.protocol.status import BriefStatus, DetailedStatus, StatusFlags

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

DISCRETES = [kind for kind in KINDS.values() if kind.bits == 1]
REGISTERS = [kind for kind in KINDS.values() if kind.bits != 1]

pages = st.integers(0, 0xFFFF)
page_bytes = st.binary(min_size=PAGE_BYTES, max_size=PAGE_BYTES)
stations = st.integers(0, 254)
loopback_data = st.lists(
    st.integers(0, 255).filter(lambda byte: byte not in {2, 3}), max_size=MAX_LOOPBACK
).map(bytes)


def elements(kinds: Iterable[str] = KINDS) -> st.SearchStrategy[Element]:
    def of(symbol: str) -> st.SearchStrategy[Element]:
        kind = KINDS[symbol]
        return st.integers(0, kind.last // kind.step).map(lambda n: Element(symbol, n * kind.step))

    return st.sampled_from(sorted(kinds)).flatmap(of)


def values(element: Element) -> st.SearchStrategy[int]:
    return st.integers(0, (1 << element.kind.bits) - 1)


@st.composite
def runs(draw: st.DrawFn, *, discrete: bool) -> tuple[Element, int]:
    """A first element and how many follow it, within the limits of 43 to 47."""
    kind = draw(st.sampled_from(DISCRETES if discrete else REGISTERS))
    limit = MAX_DISCRETES if discrete else MAX_READ_WORDS // kind.words
    count = draw(st.integers(1, limit))
    last = kind.last - (count - 1) * kind.stride
    return Element(kind.symbol, draw(st.integers(0, last // kind.step)) * kind.step), count


@st.composite
def mixtures(draw: st.DrawFn, limit: int) -> tuple[Element, ...]:
    """Elements of any kind, at most ``limit`` words in all."""
    mixture: list[Element] = []
    words = 0
    for element in draw(st.lists(elements(), min_size=1, max_size=limit)):
        words += element.kind.words
        if words > limit:
            break
        mixture.append(element)
    return tuple(mixture)


@st.composite
def write_discretes(draw: st.DrawFn) -> WriteDiscretes:
    first, count = draw(runs(discrete=True))
    return WriteDiscretes(first, tuple(draw(st.lists(st.booleans(), min_size=count, max_size=count))))


@st.composite
def write_registers(draw: st.DrawFn) -> WriteRegisters:
    first, count = draw(runs(discrete=False))
    return WriteRegisters(first, tuple(draw(st.lists(values(first), min_size=count, max_size=count))))


@st.composite
def write_mixed(draw: st.DrawFn) -> WriteMixed:
    mixture = draw(mixtures(MAX_MIXED_WRITE_WORDS))
    return WriteMixed(tuple((element, draw(values(element))) for element in mixture))


def _run(make: Callable[[Element, int], Request[Any]], *, discrete: bool) -> st.SearchStrategy[Request[Any]]:
    return runs(discrete=discrete).map(lambda run: make(*run))


BY_COMMAND: dict[Command, st.SearchStrategy[Request[Any]]] = {
    Command.BRIEF_STATUS: st.just(ReadBriefStatus()),
    Command.RUN_STOP: st.booleans().map(RunStop),
    Command.CONTROL_DISCRETE: st.builds(
        ControlDiscrete, st.sampled_from(Control), elements(kind.symbol for kind in DISCRETES)
    ),
    Command.READ_DISABLED: _run(ReadDisabled, discrete=True),
    Command.READ_DISCRETES: _run(ReadDiscretes, discrete=True),
    Command.WRITE_DISCRETES: write_discretes(),
    Command.READ_REGISTERS: _run(ReadRegisters, discrete=False),
    Command.WRITE_REGISTERS: write_registers(),
    Command.READ_MIXED: mixtures(MAX_READ_WORDS).map(ReadMixed),
    Command.WRITE_MIXED: write_mixed(),
    Command.LOOPBACK: loopback_data.map(Loopback),
    Command.READ_PAGE: pages.map(ReadPage),
    Command.WRITE_PAGE: st.builds(WritePage, pages, page_bytes),
    Command.DETAILED_STATUS: st.just(ReadDetailedStatus()),
}

requests = st.sampled_from(sorted(BY_COMMAND)).flatmap(BY_COMMAND.__getitem__)


def _tuple_of(strategy: st.SearchStrategy[Any], count: int) -> st.SearchStrategy[tuple[Any, ...]]:
    return st.lists(strategy, min_size=count, max_size=count).map(tuple)


def answers(request: Request[Any]) -> st.SearchStrategy[Any]:  # noqa: PLR0911  # a case a kind of answer
    """What a PLC may answer to this request when nothing is wrong."""
    match request:
        case ReadBriefStatus():
            byte = st.integers(0, 255)
            return st.builds(BriefStatus, st.integers(0, 127).map(StatusFlags.parse), byte, byte)
        case ReadDetailedStatus():
            return st.binary(min_size=64, max_size=64).map(DetailedStatus.parse)
        case ReadDisabled(_, count) | ReadDiscretes(_, count):
            return _tuple_of(st.booleans(), count)
        case ReadRegisters(first, count):
            return _tuple_of(values(first), count)
        case ReadMixed(mixture):
            return st.tuples(*map(values, mixture))
        case Loopback(data):
            return st.just(data)
        case ReadPage():
            return page_bytes
    return st.none()


exchanges = requests.flatmap(lambda request: st.tuples(st.just(request), answers(request)))


@st.composite
def cuts(draw: st.DrawFn, data: bytes) -> list[bytes]:
    """The same bytes in pieces."""
    places = sorted(draw(st.lists(st.integers(0, len(data)), max_size=12)))
    return [data[a:b] for a, b in zip([0, *places], [*places, len(data)], strict=True)]
