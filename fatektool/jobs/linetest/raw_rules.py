"""What a loopback test in frames of one's own (``--raw``) says about the line and the program behind it.

There is no checksum and no station in such a frame, so that less can be told from it than from 4E.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.jobs.linetest.evidence import sample
from fatektool.jobs.linetest.finding import Case, Finding

if TYPE_CHECKING:
    from fatektool.jobs.linetest.loopback.result import LoopbackResult


def raw_silence(case: Case) -> Finding | None:
    """Not a byte."""
    result = case.result
    if not case.silent or result.bytes_received:
        return None
    return Finding(
        "raw-silence",
        fault=True,
        finding="nothing comes back, not a byte",
        evidence=f"{result.total.sent} frames ({result.plan.raw}), 0 bytes heard",
        advice="is the PLC in RUN, with a program that sends back what it gets (CLINK MD2, SR+0 = 1)? Has "
        "its SR+1 these codes, and its port this speed and format? Are A and B the right way round?",
    )


def raw_nothing_right(case: Case) -> Finding | None:
    """Bytes, but never the text."""
    if not case.silent:
        return None
    return Finding(
        "raw-nothing-right",
        fault=True,
        finding="something comes back, but never what was sent",
        evidence=f"{case.result.total.sent} frames ({case.result.plan.raw}), {_came(case.result)}",
        advice=f"this line is set to {case.line}: is the PLC's port? Are its codes in SR+1 those of --raw? "
        "Does the program send back all that it gets, and the codes with it?",
    )


def raw_echo(case: Case) -> Finding | None:
    """Sooner than an answer can come."""
    if case.result.paced or case.silent:
        return None
    return Finding(
        "raw-echo",
        fault=False,
        finding=f"answers come sooner than {case.line} allows: they may be the echo of a two-wire line",
        evidence=f"{case.result.heard.faster_than_wire} of {case.result.total.ok} answers came in less than "
        "the wire time of frame and answer",
        advice="take the PLC off the line: if the answers still come, they are an echo, and prove nothing of "
        "the PLC. Where no serial line of that speed is in between (TCP, UDP) it is no echo",
    )


def raw_twice(case: Case) -> Finding | None:
    """Each text once more."""
    heard, total = case.result.heard, case.result.total
    if heard.twice < 3 or heard.twice < total.sent / 50:
        return None
    return Finding(
        "raw-twice",
        fault=True,
        finding="texts come back twice: the line echoes and the PLC answers, or two answer",
        evidence=f"{heard.twice} texts came a second time",
        advice="switch off the converter's echo, or the second PLC: these figures are of what came first",
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
        finding="some texts come back altered, cut or with more in them",
        evidence=f"{count} of {total.sent}, {_came(case.result)}",
        advice="check termination, shield and earth; a receiver without an end code parts a text at a pause "
        "of R4148's high byte (12 ms): give it more",
    )


def _came(result: LoopbackResult) -> str:
    return f"{result.heard.noise_bytes} bytes that were not asked for: {sample(result)}"
