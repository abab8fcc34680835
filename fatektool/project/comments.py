"""The texts in a project: comments of elements and networks, names of units.

::

    1006   u16 0 · u16 length · u16 length · u16 0 · project's name · model
    1001   u16 byte address of the unit · u16 length · u16 0 · name
    1002   u16 byte address of the network · u16 length · text
    1003   u16 length · element · u16 length, at most 16 · text · u16 0
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.project.code_page import Choice, choose, decoded

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fatektool.project.records import Record

_ELEMENT: Final = re.compile(r"([A-Z]{1,3})0*([0-9]{1,5})", re.ASCII)
_NAMES: Final = 0x1006
_UNIT: Final = 0x1001
_NETWORK: Final = 0x1002
_OF_ELEMENT: Final = 0x1003


@dataclass(frozen=True, slots=True)
class Comments:
    """The texts of a project.

    Attributes:
        name: of the project.
        model: of the PLC, in record 1006.
        units: byte address in the image -> the program unit's name.
        networks: byte address in the image -> the network's comment.
        elements: ``S3`` -> its comment.
        code_page: of the texts.
        sure: False if no code page decodes all of them, and latin-1 is used.
    """

    name: str
    model: str
    units: Mapping[int, str]
    networks: Mapping[int, str]
    elements: Mapping[str, str]
    code_page: str
    sure: bool


class _Raw:
    """The texts as bytes."""

    def __init__(self, records: Sequence[Record]) -> None:
        self.name = self.model = b""
        self.units: dict[int, bytes] = {}
        self.networks: dict[int, bytes] = {}
        self.elements: dict[str, bytes] = {}
        for record in records:
            self._take(record.type, record.data)

    @property
    def texts(self) -> list[bytes]:
        of_elements = list(self.elements.values())
        return [self.name, self.model, *self.units.values(), *self.networks.values(), *of_elements]

    def _take(self, kind: int, data: bytes) -> None:
        if kind == _NAMES:
            name, model = _u16(data, 2), _u16(data, 4)
            self.name, self.model = _text(data, 8, name), _text(data, 8 + name, model)
        elif kind == _UNIT:
            self.units[_u16(data, 0)] = _text(data, 6, len(data))
        elif kind == _NETWORK:
            self.networks[_u16(data, 0)] = _text(data, 4, _u16(data, 2))
        elif kind == _OF_ELEMENT:
            length = _u16(data, 0)
            element = short_element(_text(data, 2, length).decode("latin-1"))
            if element is not None:
                self.elements[element] = _text(data, 4 + length, _u16(data, 2 + length))


def comments_of(records: Sequence[Record], encoding: str | None = None) -> Comments:
    """The texts of a project.

    Args:
        records: of the project.
        encoding: the code page they were written in; None to detect it.
    """
    raw = _Raw(records)
    page = Choice(encoding, sure=True) if encoding is not None else choose(raw.texts)

    def plain(text: bytes) -> str:
        try:
            found = decoded(text, page.name)
        except UnicodeDecodeError:  # in a code page that the user gave
            found = text.decode(page.name, "replace")
        return "".join(letter if letter.isprintable() else " " for letter in found).strip()

    return Comments(
        name=plain(raw.name),
        model=plain(raw.model),
        units={place: plain(text) for place, text in raw.units.items()},
        networks={place: plain(text) for place, text in raw.networks.items()},
        elements={element: plain(text) for element, text in raw.elements.items() if plain(text)},
        code_page=page.name,
        sure=page.sure,
    )


def text_in(addresses: range, texts: Mapping[int, str]) -> str | None:
    """The text of a network or unit that begins in this range of byte addresses; None if there is none."""
    found = texts.get(addresses.start)
    if found is None:
        found = next((text for address, text in texts.items() if address in addresses), None)
    return found


def comment_of(element: str, comments: Mapping[str, str]) -> str | None:
    """The comment of an element: its own, or that of the register or timer that it belongs to.

    Args:
        element: such as ``DR2``, which has that of R2, or ``RT5``, which has that of T5.
        comments: of a project.
    """
    plain = element if element[1:2].isdigit() else element.removeprefix("D")  # D2 is not a pair
    for name in (element, plain, plain.removeprefix("R") if plain[:2] in {"RT", "RC"} else plain):
        if name in comments:
            return comments[name]
    return None


def short_element(text: str) -> str | None:
    """An element in the usual form: ``R12`` for ``R00012``; None if it is not one."""
    found = _ELEMENT.fullmatch(text.strip().upper())
    return f"{found[1]}{int(found[2])}" if found else None


def _text(data: bytes, place: int, length: int) -> bytes:
    return data[place : place + length].partition(b"\0")[0]


def _u16(data: bytes, place: int) -> int:
    return int.from_bytes(data[place : place + 2], "little")
