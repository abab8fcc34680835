"""``decode``: frames explained."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

import click

from fatektool.cli.line.documents.frames import decode_document
from fatektool.cli.line.frame_view import field_lines
from fatektool.cli.shared.options import ChoiceType, voice_options
from fatektool.cli.shared.pairs import together
from fatektool.counts import counted
from fatektool.errors import DataError, UsageError
from fatektool.files.atomic import read_bounded
from fatektool.protocol.explain import Explainer, Explanation, FrameRole
from fatektool.protocol.registry import new_explainer
from fatektool.protocols import DEFAULT, PROTOCOLS
from fatektool.transport.trace import RECEIVED
from fatektool.transport.trace_reader import TraceRecord, read_trace

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from fatektool.cli.shared.output import Voice

_MAX_TRACE = 256 << 20
_ROLES = {"request": FrameRole.REQUEST, "answer": FrameRole.ANSWER}


@click.command(
    "decode", epilog="Examples: fatektool decode 02 30 31 34 30 43 37 03;  fatektool decode line.pcap"
)
@click.argument("frames", nargs=-1, required=True, metavar="HEX…|FILE")
@click.option(
    "--protocol",
    type=ChoiceType(PROTOCOLS),
    help="Protocol of the frames.  [default: that of the trace, else facon]",
)
@click.option("--as", "role", type=click.Choice(list(_ROLES)), help="What frames given as hex are.")
@voice_options
def decode_command(
    frames: tuple[str, ...],
    voice: Voice,
    *,
    protocol: str | None,
    role: str | None,
) -> int:
    """Explain frames: each field, and whether the checksum is correct.

    Frames are given as HEX or read from a trace FILE (.ndjson, .pcap). All are shown; exit 5 if one is
    damaged, such as by a wrong checksum, or if there is none.
    """
    records, damage = _gathered(frames)
    together("role", holds=all(not record.time for record in records), needs="frames given as hex")
    protocol = protocol or _protocol_of(records)
    explainer = new_explainer(protocol)
    found = list(_explained(explainer, records, _ROLES.get(role or "", FrameRole.EITHER)))
    if damage is not None:
        if found and not voice.json:  # what stands before the damage is worth a look
            voice.show({}, _lines(found, binary=explainer.binary))
        raise damage
    if not any(explanation.command is not None for _, explanation in found):
        others = " or ".join(name for name in PROTOCOLS if name != protocol)
        raise DataError(
            f"no {protocol} frame found: expected {explainer.form}", hint=f"try --protocol {others}"
        )
    document = decode_document(protocol, found)
    voice.show(document, _lines(found, binary=explainer.binary))
    damaged = sum(explanation.fault is not None for _, explanation in found)
    if damaged:
        voice.warn(f"{damaged} of {counted(len(found), 'frame')} damaged")
    return DataError.exit_code if damaged else 0


def _protocol_of(records: Iterable[TraceRecord]) -> str:
    """The protocol that a trace names; FACON if it names none that is known."""
    return next((record.protocol for record in records if record.protocol in PROTOCOLS), DEFAULT)


def _gathered(frames: tuple[str, ...]) -> tuple[list[TraceRecord], DataError | None]:
    """The bytes to explain, up to the end or to damage."""
    records: list[TraceRecord] = []
    try:
        for record in _records(frames):
            records.append(record)  # noqa: PERF402  # so that what came before an error is kept
    except DataError as error:
        return records, error
    return records, None


def _explained(
    explainer: Explainer, records: Iterable[TraceRecord], role: FrameRole
) -> Iterator[tuple[TraceRecord | None, Explanation]]:
    for record in records:
        typed = record.time == ""
        known = role if typed else _direction(record)
        for explanation in explainer.explain(record.data, known):
            yield (None if typed else record), explanation


def _records(frames: tuple[str, ...]) -> Iterator[TraceRecord]:
    """The bytes to explain; hex has no time."""
    text = "".join(frames)
    digits = re.sub(r"0[xX]|[\s,;:\-]", "", text)
    if re.fullmatch(r"(?:[0-9A-Fa-f]{2})+", digits):
        yield TraceRecord("", "", bytes.fromhex(digits))
        return
    if len(frames) == 1 and os.path.exists(frames[0]):  # noqa: PTH110  # Path's raises if the name is long
        yield from read_trace(read_bounded(Path(frames[0]), _MAX_TRACE), frames[0])
        return
    raise UsageError(f"{text[:60]!r} is neither hex digits in pairs nor an existing trace file")


def _direction(record: TraceRecord) -> FrameRole:
    return FrameRole.ANSWER if record.direction == RECEIVED else FrameRole.REQUEST


def _lines(found: Iterable[tuple[TraceRecord | None, Explanation]], *, binary: bool) -> Iterator[str]:
    for number, (record, explanation) in enumerate(found):
        if number:
            yield ""
        when = f"{record.time} {record.direction}  " if record else ""
        size = len(explanation.raw)
        yield f"{when}{explanation.role.value}, {size} bytes"
        yield from field_lines(explanation, binary=binary)
