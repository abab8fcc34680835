"""A simulator's memory in a file: taken whole, or refused in one plain line."""

from __future__ import annotations

import json

from fatektool.errors import DataError
from fatektool.simulator.build import build_simulation
from fatektool.simulator.state import dump_state, parse_state
from fuzz.documents import json_of
from fuzz.words import require_plain


def _good() -> object:
    simulation = build_simulation(ladder_words=64)
    device = simulation.plcs[1]
    device.write_words("R", 3, [7])
    device.set_input(2, 1)
    device.running = True
    return json.loads(dump_state([device]))


GOOD = _good()


def one_input(data: bytes) -> None:
    """Read; what is taken is written, read again and the same."""
    try:
        found = parse_state(json_of(GOOD, data), "plc.state")
    except DataError as error:
        require_plain(error)
        return
    text = dump_state(found)
    assert dump_state(parse_state(text, "again")) == text
