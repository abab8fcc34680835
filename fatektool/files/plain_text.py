"""Text files as people's editors write them: UTF-8, with or without a byte order mark.

Windows puts the mark in front, and PowerShell's ``>`` writes UTF-16, which is refused in one clear line: half
of such a file would be NUL to whoever took it for UTF-8.
"""

from __future__ import annotations

from typing import Final

_MARK: Final = b"\xef\xbb\xbf"


class EncodingError(ValueError):
    """Bytes that are no text in UTF-8."""


def plain_text(data: bytes) -> str:
    """Read text.

    Raises:
        EncodingError: it is not UTF-8; says what it is, and what to do.
    """
    if data[:2] in {b"\xff\xfe", b"\xfe\xff"} or b"\0" in data[:2]:
        raise EncodingError(
            "text in UTF-16, expected UTF-8: save it as UTF-8, in PowerShell with '| Out-File -Encoding utf8'"
        )
    text = data.removeprefix(_MARK)
    try:
        return text.decode("utf-8")  # not utf-8-sig: Python would have to find that codec's file first
    except UnicodeDecodeError as error:
        place = error.start + len(data) - len(text)
        raise EncodingError(f"no text in UTF-8: byte {place} is {data[place]:02X}") from error
