"""The simulator, whatever a client sends it: it answers, and it goes on answering.

The first byte chooses the protocol, and whether what follows gets a frame around it.
"""

from __future__ import annotations

from fatektool.simulator.build import build_simulation
from tests.protocol.decoding import framed, frames, sealed

BRIEF = {"facon": framed(b"0140"), "mseries": sealed(0x51, b"\x01\x40")}
MOST = 2 * (8 + 512) + 8
"""More than two of the longest answers that there are: to what was sent, and to the question behind it."""
FLUSH = bytes(600)
"""Longer than any frame: what a header in noise could still wait for."""


def one_input(data: bytes) -> None:
    """Send bytes, then a question."""
    kind, rest = data[:1] or b"\0", data[1:]
    protocol = "mseries" if kind[0] & 1 else "facon"
    if kind[0] & 2:
        rest = framed(rest) if protocol == "facon" else sealed(0x51, rest)
    simulation = build_simulation(protocol=protocol, ladder_words=64)
    line = simulation.line()
    answers = b"".join(piece for _, piece in line.receive(rest, 0.0))
    assert len(answers) <= MOST * (1 + rest.count(b"\x03") + rest.count(b"\x55\xaa"))
    line.receive(FLUSH, 1.0)
    asked = b"".join(piece for _, piece in line.receive(BRIEF[protocol], 2.0))
    assert asked, "no answer to a good question behind it"
    if protocol == "facon":
        assert len(frames([asked])) == 1
