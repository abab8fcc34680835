"""The reason that some gateways send as text before they close: "Port already in use" and the like."""

from __future__ import annotations

from typing import Final

from fatektool.transport.base import MOST_SAID

_LEAST_SAID: Final = 4


def said_text(data: bytes) -> str:
    """The first line of a short text; empty if the bytes are not text. No frame of a PLC is.

    Args:
        data: all bytes received over a connection.
    """
    text = data.decode("ascii", errors="replace").strip()
    first = text.splitlines()[0].strip() if text else ""
    words = first.isprintable() and first.isascii() and " " in first  # a Modbus ASCII frame has no space
    return first if words and _LEAST_SAID <= len(first) <= len(data) <= MOST_SAID else ""
