"""Any valid request, any answer that matches it, and streams cut anywhere."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from hypothesis import strategies as st

from fatektool.errors import UsageError
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
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.protocol.fatek.mseries.codec import MSERIES
from fatektool.protocol.status import BriefStatus, DetailedStatus, StatusFlags

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from fatektool.protocol.codec import Codec


pages = st.integers(0, 0xFFFF)
page_bytes = st.binary(min_size=PAGE_BYTES, max_size=PAGE_BYTES)
stations = st.integers(0, 254)


def elements(kinds: Iterable[str] = tuple(KINDS)) -> st.SearchStrategy[Element]:
    def of(symbol: str) -> st.SearchStrategy[Element]:
        kind = KINDS[symbol]
        return st.integers(0, kind.last // kind.step).map(lambda n: Element(symbol, n * kind.step))

    return st.sampled_from(sorted(kinds)).flatmap(of)


def values(element: Element) -> st.SearchStrategy[int]:
    return st.integers(0, (1 << element.kind.bits) - 1)


def discretes(kinds: Iterable[str]) -> list[str]:
    return [symbol for symbol in kinds if KINDS[symbol].bits == 1]


def registers(kinds: Iterable[str]) -> list[str]:
    return [symbol for symbol in kinds if KINDS[symbol].bits != 1]


@st.composite
def runs(draw: st.DrawFn, symbols: list[str]) -> tuple[Element, int]:
    """A first element and how many follow it, within the limits of 43 to 47."""
    kind = KINDS[draw(st.sampled_from(symbols))]
    limit = MAX_DISCRETES if kind.bits == 1 else MAX_READ_WORDS // kind.words
    count = draw(st.integers(1, limit))
    last = kind.last - (count - 1) * kind.stride
    return Element(kind.symbol, draw(st.integers(0, last // kind.step)) * kind.step), count


@st.composite
def mixtures(draw: st.DrawFn, limit: int, kinds: Iterable[str]) -> tuple[Element, ...]:
    """Elements of any kind, at most ``limit`` words in total."""
    mixture: list[Element] = []
    words = 0
    for element in draw(st.lists(elements(kinds), min_size=1, max_size=limit)):
        words += element.kind.words
        if words > limit:
            break
        mixture.append(element)
    return tuple(mixture)


@st.composite
def write_discretes(draw: st.DrawFn, kinds: Iterable[str]) -> WriteDiscretes:
    first, count = draw(runs(discretes(kinds)))
    return WriteDiscretes(first, tuple(draw(st.lists(st.booleans(), min_size=count, max_size=count))))


@st.composite
def write_registers(draw: st.DrawFn, kinds: Iterable[str]) -> WriteRegisters:
    first, count = draw(runs(registers(kinds)))
    return WriteRegisters(first, tuple(draw(st.lists(values(first), min_size=count, max_size=count))))


@st.composite
def write_mixed(draw: st.DrawFn, kinds: Iterable[str]) -> WriteMixed:
    mixture = draw(mixtures(MAX_MIXED_WRITE_WORDS, kinds))
    return WriteMixed(tuple((element, draw(values(element))) for element in mixture))


def _run(make: Callable[[Element, int], Request[Any]], symbols: list[str]) -> st.SearchStrategy[Request[Any]]:
    return runs(symbols).map(lambda run: make(*run))


def _by_command(kinds: tuple[str, ...], alphabet: bytes) -> dict[Command, st.SearchStrategy[Request[Any]]]:
    loopback_data = st.lists(st.sampled_from(alphabet), max_size=MAX_LOOPBACK).map(bytes)
    return {
        Command.BRIEF_STATUS: st.just(ReadBriefStatus()),
        Command.RUN_STOP: st.booleans().map(RunStop),
        Command.CONTROL_DISCRETE: st.builds(
            ControlDiscrete, st.sampled_from(Control), elements(discretes(kinds))
        ),
        Command.READ_DISABLED: _run(ReadDisabled, discretes(kinds)),
        Command.READ_DISCRETES: _run(ReadDiscretes, discretes(kinds)),
        Command.WRITE_DISCRETES: write_discretes(kinds),
        Command.READ_REGISTERS: _run(ReadRegisters, registers(kinds)),
        Command.WRITE_REGISTERS: write_registers(kinds),
        Command.READ_MIXED: mixtures(MAX_READ_WORDS, kinds).map(ReadMixed),
        Command.WRITE_MIXED: write_mixed(kinds),
        Command.LOOPBACK: loopback_data.map(Loopback),
        Command.READ_PAGE: pages.map(ReadPage),
        Command.WRITE_PAGE: st.builds(WritePage, pages, page_bytes),
        Command.DETAILED_STATUS: st.just(ReadDetailedStatus()),
    }


_NOT_STX_OR_ETX = bytes(set(range(256)) - {2, 3})
_BY_CODEC = {
    FACON.name: _by_command(tuple(KINDS), _NOT_STX_OR_ETX),
    MSERIES.name: _by_command(tuple(KINDS), bytes(range(256))),
}
BY_COMMAND = _BY_CODEC[FACON.name]


def requests_of(codec: Codec) -> st.SearchStrategy[Request[Any]]:
    """Any request that this protocol can say."""
    by_command = _BY_CODEC[codec.name]
    any_of = st.sampled_from(sorted(codec.commands)).flatmap(by_command.__getitem__)
    return any_of if codec is FACON else any_of.filter(lambda request: _can_say(codec, request))


def _can_say(codec: Codec, request: Request[Any]) -> bool:
    """False for the few addresses that a symbol of no length would be taken for another by."""
    try:
        codec.encode(1, request)
    except UsageError:
        return False
    return True


requests = requests_of(FACON)


def _tuple_of(strategy: st.SearchStrategy[Any], count: int) -> st.SearchStrategy[tuple[Any, ...]]:
    return st.lists(strategy, min_size=count, max_size=count).map(tuple)


def answers(  # noqa: PLR0911  # a case a kind of answer
    request: Request[Any], codec: Codec = FACON
) -> st.SearchStrategy[Any]:
    """What a PLC may answer to this request when nothing is wrong."""
    m_series = codec is MSERIES
    match request:
        case ReadBriefStatus():
            byte = st.integers(0, 255)
            flags = st.integers(0, 127).map(StatusFlags.parse)
            return st.builds(BriefStatus, flags, byte, byte, st.just(m_series))
        case ReadDetailedStatus():
            documented = st.binary(min_size=64, max_size=64)
            return documented.map(partial(DetailedStatus.parse, assumed=m_series))
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


def exchanges_of(codec: Codec) -> st.SearchStrategy[tuple[Request[Any], Any]]:
    """Any request, and an answer to it."""
    return requests_of(codec).flatmap(lambda request: st.tuples(st.just(request), answers(request, codec)))


exchanges = exchanges_of(FACON)


@st.composite
def cuts(draw: st.DrawFn, data: bytes) -> list[bytes]:
    """The same bytes in pieces."""
    places = sorted(draw(st.lists(st.integers(0, len(data)), max_size=12)))
    return [data[a:b] for a, b in zip([0, *places], [*places, len(data)], strict=True)]
