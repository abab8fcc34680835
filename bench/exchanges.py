"""The requests of each job with the lengths of their answers, made by hand: what a bare loop sends.

They are the fewest that could do the job, and owe nothing to the tool: no fence, no second status.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

Exchange = tuple[bytes, int]
"""A request, and how many bytes its answer has."""

FRAME = 8  # STX, station, command, LRC, ETX
PAGE_DIGITS = 256
ALL_REGISTERS = {"R0": 8072, "D0": 3072, "RT": 256, "RC": 256}
ALL_DISCRETES = {"X": 256, "Y": 256, "T": 256, "C": 256, "S": 1000, "M": 2002}


def ask(text: str, answer_data: int) -> Exchange:
    """A request to station 1, and an answer of so many characters between command and checksum."""
    body = b"\x02" + f"01{text}".encode()
    return b"%b%02X\x03" % (body, sum(body) & 0xFF), FRAME + answer_data


def status() -> list[Exchange]:
    """53."""
    return [ask("53", 1 + 2 * 64)]


def reading(pages: int) -> list[Exchange]:
    """4F for every page."""
    return [ask(f"4F{page:04X}", 1 + PAGE_DIGITS) for page in range(pages)]


def writing(pages: Iterable[tuple[int, bytes]]) -> list[Exchange]:
    """50 for these pages."""
    return [ask(f"50{page:04X}{data.hex().upper()}", 1) for page, data in pages]


def backup(pages: int) -> list[Exchange]:
    """The capacity once, and all pages twice."""
    return [*status(), *reading(pages), *reading(pages)]


def known(pages: int, again: Sequence[int]) -> list[Exchange]:
    """The capacity, all pages once, and those that differ from the file once more."""
    found = [*status(), *reading(pages)]
    return [*found, *(ask(f"4F{page:04X}", 1 + PAGE_DIGITS) for page in again)]


def verify(pages: int) -> list[Exchange]:
    """The capacity, and all pages once."""
    return [*status(), *reading(pages)]


def restore(pages: int, differ: Sequence[int], changed: Sequence[tuple[int, bytes]]) -> list[Exchange]:
    """The present program, what is not in the file a second time, the pages to write, and all read back.

    A second time also the pages beside those: they would differ too if the program changed meanwhile.
    """
    beside = {page + step for page in differ for step in (-1, 0, 1)}
    again = sorted(page for page in beside if 0 <= page < pages)
    return [*known(pages, again), *writing(changed), *reading(pages)]


def snapshot() -> list[Exchange]:
    """All that an FBE-28MC has: registers by 64; discretes by words of 16, in a fourth of the bytes."""
    found = [ask("40", 1 + 6)]
    for name, count in ALL_REGISTERS.items():
        found += _runs(name, count, 6, 64, 1)
    for symbol, count in ALL_DISCRETES.items():
        found += _runs(f"W{symbol}", -(-count // 16) - (count % 16 != 0), 6, 64, 16)
        if count % 16:
            first = count // 16 * 16
            found.append(ask(f"44{count % 16:02X}{symbol}{first:04}", 1 + count % 16))
    return found


def _runs(name: str, count: int, width: int, most: int, stride: int) -> list[Exchange]:
    symbol = name.rstrip("0")
    width -= len(symbol)
    return [
        ask(f"46{min(most, count - at):02X}{symbol}{at * stride:0{width}}", 1 + 4 * min(most, count - at))
        for at in range(0, count, most)
    ]


def wire_bytes(exchanges: Iterable[Exchange]) -> int:
    """All bytes of requests and answers."""
    return sum(len(request) + size for request, size in exchanges)
