"""Words of code: each comes out in one instruction, and all come back; a circuit of them can be drawn."""

from __future__ import annotations

import struct

from fatektool.ladder.circuit.reading import NoCircuit, circuit_of
from fatektool.ladder.circuit.writing import instructions_of
from fatektool.ladder.cross_reference import CrossReference
from fatektool.ladder.decode import encode
from fatektool.ladder.drawing.text.draw import draw
from fatektool.ladder.drawing.text.letters import Letters, width_of
from fatektool.ladder.drawing.text.pen import Pen
from fatektool.ladder.networks import Code

_PEN = Pen(Letters())


def one_input(data: bytes) -> None:
    """Decode; the instructions' words in order are the words, and each has a text."""
    words = struct.unpack(f">{len(data) // 2}H", data[: len(data) // 2 * 2])
    code = Code.of(words)
    assert encode(code.instructions) == code.words == words
    for instruction in code.instructions:
        assert instruction.text.isprintable()
        assert instruction.known or instruction.text.startswith("?? ")
        list(instruction.accesses)
    for finding in CrossReference(code).findings():
        assert finding.where
    for network in code.networks:
        circuit = circuit_of(network)
        if isinstance(circuit, NoCircuit):
            assert circuit.reason.isprintable()
        else:
            assert instructions_of(circuit) == network.instructions
            assert all(width_of(line) <= 60 for line in draw(circuit, {}, 60, _PEN))
