"""What follows a command in words: elements, values, bytes. Which command takes what: ``command_words``."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from fatektool.errors import UsageError
from fatektool.jobs.elements.assignment import parse_assignment
from fatektool.jobs.elements.selection import parse_item
from fatektool.protocol.commands import (
    Control,
    ControlDiscrete,
    Loopback,
    ReadBriefStatus,
    ReadDetailedStatus,
    ReadMixed,
    ReadPage,
    RunStop,
    WriteDiscretes,
    WriteMixed,
    WritePage,
    WriteRegisters,
)
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fatektool.protocol.commands import Request

    Words = Sequence[str]


class Reader(Protocol):
    """Reads the operands of a command, and where it is wanted what a PLC answers."""

    def __call__(self, words: Words, *, answer: bool) -> Spoken:
        """Read them.

        Raises:
            WrongOperands: they do not have the form of the command.
            UsageError: they have, and mean nothing.
        """


class Spoken(NamedTuple):
    """A request, and what a PLC answers to it.

    Attributes:
        request: what is asked.
        answer: what is answered; None for a mere acknowledgement, and where no answer was asked for.
    """

    request: Request[Any]
    answer: Any = None


class WrongOperands(Exception):  # ``command_words`` catches it; no user sees it
    """The operands do not have the form of the command."""


def _none(words: Words) -> None:
    if words:
        raise WrongOperands


def _one(words: Words) -> str:
    if len(words) != 1:
        raise WrongOperands
    return words[0]


def brief_status(words: Words, *, answer: bool) -> Spoken:
    """40."""
    if not answer:
        _none(words)
        return Spoken(ReadBriefStatus())
    return Spoken(ReadBriefStatus(), brief(_hex(words), m_series=False))


def brief(data: bytes, *, m_series: bool) -> Any:
    """The three bytes of 40."""
    from fatektool.protocol.status import BriefStatus

    if len(data) != 3:
        raise UsageError(f"status: expected 3 bytes in hex, got {len(data)}")
    return BriefStatus.parse(data, m_series=m_series)


def detailed_status(words: Words, *, answer: bool) -> Spoken:
    """53."""
    if not answer:
        _none(words)
        return Spoken(ReadDetailedStatus())
    from fatektool.protocol.status import DetailedStatus

    data = _hex(words)
    if len(data) != 64:
        raise UsageError(f"status: expected 64 bytes in hex, got {len(data)}")
    return Spoken(ReadDetailedStatus(), DetailedStatus.parse(data))


def run_stop(words: Words, *, answer: bool) -> Spoken:
    """41."""
    del answer
    word = _one(words).lower()
    if word not in {"run", "stop"}:
        raise WrongOperands
    return Spoken(RunStop(word == "run"))


def control(words: Words, *, answer: bool) -> Spoken:
    """42."""
    del answer
    if len(words) != 2 or words[0].upper() not in Control.__members__:
        raise WrongOperands
    return Spoken(ControlDiscrete(Control[words[0].upper()], Element.parse(words[1])))


def _run(words: Words) -> tuple[Element, int]:
    """Neighbours: the first and how many."""
    if len(words) == 2 and words[1].isascii() and words[1].isdigit():
        return Element.parse(words[0]), int(words[1][:9])
    items = parse_item(_one(words))
    return items[0].element, len(items)


def _values(words: Words) -> tuple[Element, tuple[int, ...]]:
    """Neighbours with their values."""
    if not words or any("=" not in word for word in words):
        raise WrongOperands
    pairs = [(item.element, value) for word in words for item, value in parse_assignment(word)]
    first = pairs[0][0]
    for place, (element, _) in enumerate(pairs):
        if element != first.after(place):
            raise UsageError(
                f"{element}: expected {first.after(place)}, the next address",
                hint="use 48 or 49 for elements that are not consecutive",
            )
    return first, tuple(value for _, value in pairs)


def reads(make: Callable[[Element, int], Request[Any]], *, of_bits: bool) -> Reader:
    """43, 44 and 46."""

    def parse(words: Words, *, answer: bool) -> Spoken:
        if not answer:
            return Spoken(make(*_run(words)))
        first, values = _values(words)
        return Spoken(make(first, len(values)), tuple(map(bool, values)) if of_bits else values)

    return parse


def writes_discretes(words: Words, *, answer: bool) -> Spoken:
    """45."""
    del answer
    first, values = _values(words)
    return Spoken(WriteDiscretes(first, tuple(map(bool, values))))


def writes_registers(words: Words, *, answer: bool) -> Spoken:
    """47."""
    del answer
    return Spoken(WriteRegisters(*_values(words)))


def read_mixed(words: Words, *, answer: bool) -> Spoken:
    """48."""
    if not words:
        raise WrongOperands
    if not answer:
        return Spoken(ReadMixed(tuple(item.element for word in words for item in parse_item(word))))
    pairs = [(item.element, value) for word in words for item, value in parse_assignment(word)]
    return Spoken(ReadMixed(tuple(element for element, _ in pairs)), tuple(value for _, value in pairs))


def write_mixed(words: Words, *, answer: bool) -> Spoken:
    """49."""
    del answer
    if not words:
        raise WrongOperands
    pairs = [(item.element, value) for word in words for item, value in parse_assignment(word)]
    return Spoken(WriteMixed(tuple(pairs)))


def loopback(words: Words, *, answer: bool) -> Spoken:
    """4E."""
    text = _one(words)
    try:
        data = text.encode("latin-1")
    except UnicodeEncodeError:
        raise UsageError(
            "loopback: expected characters of one byte", hint="--data takes bytes in hex"
        ) from None
    return Spoken(Loopback(data), data if answer else None)


def read_page(words: Words, *, answer: bool) -> Spoken:
    """4F."""
    if not answer:
        return Spoken(ReadPage(_page(_one(words))))
    if len(words) < 2:
        raise WrongOperands
    request = WritePage(_page(words[0]), _hex(words[1:]))  # which checks the length
    return Spoken(ReadPage(request.page), request.data)


def write_page(words: Words, *, answer: bool) -> Spoken:
    """50."""
    del answer
    if len(words) < 2:
        raise WrongOperands
    return Spoken(WritePage(_page(words[0]), _hex(words[1:])))


def _page(text: str) -> int:
    if not (text.isascii() and text.isdigit()):
        raise WrongOperands
    return int(text[:9])


def _hex(words: Words) -> bytes:
    digits = parse_hex("".join(words))
    if not digits:
        raise WrongOperands
    return digits


def parse_hex(text: str) -> bytes:
    """Bytes in hex, in any usual spelling.

    Raises:
        UsageError: they are not digits in pairs.
    """
    digits = re.sub(r"0[xX]|[\s,;:\-]", "", text)
    if not re.fullmatch(r"(?:[0-9A-Fa-f]{2})*", digits):
        raise UsageError(f"{text[:60]!r}: expected hex digits in pairs")
    return bytes.fromhex(digits)
