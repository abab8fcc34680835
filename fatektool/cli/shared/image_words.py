"""What is unusual in a program image, in words, for every command that shows one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.program.headers.header import FBS
from fatektool.program.image import ranges

if TYPE_CHECKING:
    from fatektool.cli.shared.output import Voice
    from fatektool.program.image import Program


def warn_of_image(program: Program, voice: Voice) -> None:
    """Warn of what is invalid or unusual in an image, and of pages that the PLC refused."""
    for fault in program.header_faults:
        voice.warn(f"invalid header of the program: {fault}")
    for odd in program.header.odd:
        voice.warn(odd)
    refused = refused_pages(program)
    if refused is not None and program.header.family == FBS:
        voice.say(voice.name + refused)
    elif refused is not None:
        voice.warn(refused)


def image_warnings(program: Program) -> list[str]:
    """The same for JSON, but for the faults, which have a key of their own."""
    refused = refused_pages(program)
    return [*program.header.odd, *([] if refused is None else [refused])]


def refused_pages(program: Program) -> str | None:
    """What the PLC did not give of the pages that its ladder size asks for; None if it gave all."""
    count, asked = len(program.pages), program.pages_asked_for
    if count == asked:
        return None
    pages = "page" if asked == count + 1 else "pages"
    said = f"the PLC refused {pages} {ranges(range(count, asked))} as past its end and gave {count} pages"
    announced = program.header.announced_pages
    if announced is None or announced > count:
        return f"{said}; its ladder size of {program.ladder_words} words asks for {asked}"
    return f"{said}: all that the program's header announces"
