"""The diagnosis of a loopback test with ``--raw``, in frames of the user's own ladder program.

Such a frame has no checksum and no station, so there are fewer rules than for 4E.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.jobs.linetest.evidence import sample
from fatektool.jobs.linetest.finding import Case, Finding

if TYPE_CHECKING:
    from fatektool.jobs.linetest.loopback.result import LoopbackResult


def raw_silence(case: Case) -> Finding | None:
    """No bytes at all."""
    result = case.result
    if not case.silent or result.bytes_received:
        return None
    return Finding(
        "raw-silence",
        fault=True,
        finding="no bytes received",
        evidence=f"{result.total.sent} frames ({result.plan.raw}), 0 bytes received",
        advice="check that the PLC is in RUN, with a program that returns what it receives (CLINK MD2, "
        "SR+0 = 1), the codes in its SR+1, baud rate and format of its port, and wires A and B",
    )


def raw_nothing_right(case: Case) -> Finding | None:
    """Bytes, but never the text that was sent."""
    if not case.silent:
        return None
    return Finding(
        "raw-nothing-right",
        fault=True,
        finding="bytes are received, but never the text that was sent",
        evidence=f"{case.result.total.sent} frames ({case.result.plan.raw}), {_came(case.result)}",
        advice=f"this line is set to {case.line}: check the port of the PLC, and that its SR+1 has the codes "
        "of --raw; the program must return all that it receives, with the codes",
    )


def raw_echo(case: Case) -> Finding | None:
    """Answers faster than the line allows."""
    if case.result.paced or case.silent:
        return None
    return Finding(
        "raw-echo",
        fault=False,
        finding=f"answers arrive faster than {case.line} allows: they may be the echo of a two-wire line",
        evidence=f"{case.result.heard.faster_than_wire} of {case.result.total.ok} answers took less than "
        "the wire time of frame and answer",
        advice="disconnect the PLC: answers that are still received are an echo, and say nothing about the "
        "PLC; over TCP or UDP it is no echo",
    )


def raw_twice(case: Case) -> Finding | None:
    """Texts that are received twice."""
    heard, total = case.result.heard, case.result.total
    if heard.twice < 3 or heard.twice < total.sent / 50:
        return None
    return Finding(
        "raw-twice",
        fault=True,
        finding="texts are received twice: the line echoes and the PLC answers, or two PLCs answer",
        evidence=f"{heard.twice} texts were received twice",
        advice="disable the echo of the converter, or switch off the second PLC: the figures are of the text "
        "that is received first",
    )


def raw_altered(case: Case) -> Finding | None:
    """Another text than was sent."""
    total = case.result.total
    count = total.errors["mismatch"] + total.errors["garbled"]
    if not count:
        return None
    return Finding(
        "raw-altered",
        fault=True,
        finding="some texts are received altered, cut off, or with additional bytes",
        evidence=f"{count} of {total.sent}, {_came(case.result)}",
        advice="check termination, shield and earth; without an end code the PLC ends a text at a pause of "
        "12 ms (high byte of R4148): set a longer one",
    )


def _came(result: LoopbackResult) -> str:
    return f"{result.heard.noise_bytes} bytes that were not expected: {sample(result)}"
