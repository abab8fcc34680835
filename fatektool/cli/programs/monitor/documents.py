"""The JSON documents of ``monitor``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.cli.programs.monitor.words import WhyWords, program_words
from fatektool.ladder.power.values import shown_bit
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fatektool.client import Plc
    from fatektool.jobs.monitor.same_program import SameProgram
    from fatektool.jobs.monitor.why import Why, Writer
    from fatektool.ladder.power.causes import Cause, Condition


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
