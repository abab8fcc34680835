"""The JSON documents of ``monitor``."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any

from fatektool.cli.programs.monitor.words import WhyWords, program_words
from fatektool.ladder.circuit.reading import NoCircuit
from fatektool.ladder.power.flow import power_of
from fatektool.ladder.power.values import Shown, number_of, shown_bit
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fatektool.client import Plc
    from fatektool.jobs.monitor.live import LiveNetwork, Monitor
    from fatektool.jobs.monitor.rounds import Round
    from fatektool.jobs.monitor.same_program import SameProgram
    from fatektool.jobs.monitor.why import Why, Writer
    from fatektool.ladder.power.causes import Cause, Condition
    from fatektool.ladder.power.logic import State
    from fatektool.ladder.power.walk import Walk


def program_document(found: SameProgram) -> dict[str, Any]:
    """What is known of the PLC's program beside the file's."""
    return {
        "compared": found.sameness.value,
        "pages": list(found.pages),
        "differ": list(found.different),
        "checksum": found.has_sums,
        "reason": found.reason,
        "says": program_words(found),
    }


def monitor_document(plc: Plc, monitor: Monitor, found: Round) -> dict[str, Any]:
    """``fatektool.monitor/1``: one round."""
    shown = {each.name: each for network in monitor.networks for each in network.shown}
    return {
        "schema": "fatektool.monitor/1",
        "time": found.time,
        "target": plc.target,
        "station": plc.link.station,
        "protocol": plc.link.codec.name,
        "file": monitor.program.file.name,
        "program": program_document(monitor.program),
        "running": found.running,
        "duration_s": round(found.duration_s, 3),
        "values": {name: _value(found.values.get(name), each) for name, each in shown.items()},
        "errors": {name: reason for name, reason in found.errors.items() if name in shown},
        "networks": [_network(each, found) for each in monitor.networks],
    }


def _value(raw: int | None, shown: Shown) -> bool | float | str | None:
    if raw is None:
        return None
    if shown.bits == 1:
        return bool(raw)
    value = number_of(raw, shown)
    return value if isfinite(value) else str(value)


def _network(each: LiveNetwork, found: Round) -> dict[str, Any]:
    """What carries in a network, instruction by instruction."""
    if isinstance(each.circuit, NoCircuit):
        return {"number": each.network.number, "reason": each.circuit.reason, "instructions": []}
    walk = power_of(each.circuit, found.values.get)
    instructions = [
        {"number": number, "text": instruction.text, "carries": list(carried)}
        for number, _, instruction in each.network.places
        if (carried := walk.reached.get(number) or _after(walk, number))
    ]
    return {"number": each.network.number, "reason": None, "instructions": instructions}


def _after(walk: Walk[State], number: int) -> tuple[State, ...]:
    return (walk.after[number],) if number in walk.after else ()


def why_document(plc: Plc, why: Why, program: SameProgram, comments: Mapping[str, str]) -> dict[str, Any]:
    """``fatektool.why/1``."""
    words = WhyWords(why, comments)
    is_bit = Element.parse(why.element).kind.bits == 1
    value: bool | int | None = why.value
    return {
        "schema": "fatektool.why/1",
        "time": why.round.time,
        "target": plc.target,
        "station": plc.link.station,
        "protocol": plc.link.codec.name,
        "file": program.file.name,
        "program": program_document(program),
        "running": why.round.running,
        "duration_s": round(why.round.duration_s, 3),
        "element": why.element,
        "comment": comments.get(why.element),
        "value": bool(value) if is_bit and value is not None else value,
        "disabled": why.disabled,
        "says": words.answer(),
        "notes": list(words.notes()),
        "writers": [_writer(writer, words) for writer in why.writers],
        "errors": dict(why.round.errors),
    }


def _writer(writer: Writer, words: WhyWords) -> dict[str, Any]:
    return {
        "network": writer.network.number,
        "instruction": writer.leaf.number,
        "text": writer.leaf.instruction.text,
        "kind": writer.writing.value,
        "inputs": [_cause(cause, words) for cause in writer.inputs],
        "reason": writer.reason,
    }


def _cause(cause: Cause, words: WhyWords) -> dict[str, Any]:
    ways = [[_condition(each, words) for each in way] for way in cause.ways]
    return {"on": cause.state, "ways": ways}


def _condition(found: Condition, words: WhyWords) -> dict[str, Any]:
    bit = None if found.function is not None else shown_bit(found.leaf)
    return {
        "instruction": found.leaf.number,
        "text": found.leaf.instruction.text,
        "element": None if bit is None else bit.name,
        "conducts": found.conducts,
        "says": words.condition(found),
    }
