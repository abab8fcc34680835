"""The error byte of the M-series in its own paper's words, as section 2.3 has them."""

from __future__ import annotations

from typing import Any

import pytest

import fatektool
from fatektool.errors import PlcRefused
from fatektool.protocol.commands import ReadRegisters, Request, RunStop
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.mseries.codec import MSERIES, frame_bytes
from tests.protocol.decoding import frames
from tests.rows import each

R0 = ReadRegisters(Element("R", 0), 1)
TABLE = {
    0x02: "illegal value",
    0x04: "illegal format",
    0x05: "checksum",
    0x06: "ID",
    0x07: "syntax",
    0x09: "function not supported",
    0x0A: "illegal address",
}


def refused(code: int, request: Request[Any] = R0) -> PlcRefused:
    (frame,) = frames([frame_bytes(0x52, 1, request.command, bytes([code]))], MSERIES)
    with pytest.raises(PlcRefused) as caught:
        MSERIES.parse_answer(request, frame)
    return caught.value


@each("code", range(1, 256))
def test_a_code_is_told_in_the_words_of_this_paper(code: int) -> None:
    error = refused(code)
    assert error.code == code
    assert f"error {code:X}, " in error.message
    assert TABLE.get(code, "a code that the M-series paper does not list") in error.message
    assert fatektool.error_text(code, "mseries") in error.message
    assert "ROM pack" not in str(error)  # that is FACON's 3


def test_09_is_no_instruction_and_3_has_no_meaning() -> None:
    assert "instruction" not in str(refused(0x09, RunStop(run=True)))
    assert refused(0x03).hint is None
