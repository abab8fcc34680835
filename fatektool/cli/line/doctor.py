"""``doctor``: a diagnosis of a PLC and its line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.line.documents.linetest import doctor_document
from fatektool.cli.line.loopback_view import findings
from fatektool.cli.shared.colour import Style, coloured, joined, word
from fatektool.cli.shared.connection_options import connection_options
from fatektool.jobs.linetest.doctor import examine
from fatektool.program.image import ranges
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice


@click.command("doctor", epilog="Example: fatektool doctor -p sim:")
@connection_options
def doctor_command(connection: Connection, voice: Voice) -> int:
    """Diagnose a PLC and its line: each fault with its evidence and what to do.

    Takes about ten seconds and writes nothing. If there is no answer, stations 1 to 8 are tried, on a serial
    line at all baud rates of these PLCs and in the usual formats, for two minutes at most. Exit 1 if there is
    a fault.
    """
    with connection.open(voice, needs=(Command.LOOPBACK,)) as plc, voice.progress("steps") as bar:
        found = examine(plc, bar.update)
        document = doctor_document(plc, found)
    voice.show(document, _lines(document))
    return 0 if found.healthy else 1


def _lines(document: dict[str, Any]) -> Iterator[str]:
    test = document["loopback"]
    line = f" ({document['line']})" if document["line"] else ""
    yield f"station {document['station']} on {document['target']}{line}, {document['protocol']}"
    times = test["latency_ms"]
    took = "" if times["p50"] is None else f", half of them within {times['p50']:.1f} ms"
    yield f"loopback test: {test['ok']} of {test['sent']} answered{took}"
    if document["status"] is not None:
        yield joined("the PLC is in ", word("RUN" if document["status"]["running"] else "STOP"))
    if document["searched"] is not None:
        yield from _searched(
            document["searched"], found=bool(document["elsewhere"]), serial=document["line"] is not None
        )
    yield ""
    yield from findings(document["findings"])
    if document["healthy"]:
        yield coloured("no faults found", Style.GOOD)


def _searched(searched: dict[str, Any], *, found: bool, serial: bool) -> Iterator[str]:
    """What the search tried; it ended with the first station found."""
    formats: dict[str, list[int]] = {}
    for line in searched["tried"] if serial else ():
        baud, form = line.split()
        formats.setdefault(form, []).append(int(baud))
    stations = searched["stations"]
    yield f"tried station{'' if len(stations) == 1 else 's'} {ranges(stations)}"
    for form, bauds in formats.items():
        yield f"tried {form}  {', '.join(map(str, sorted(bauds)))} baud"
    if searched["refused"]:
        yield f"this port does not support {', '.join(searched['refused'])}"
    ended = "FOUND" if found else "time limit reached" if searched["out_of_time"] else "no answer"
    yield f"searched {searched['duration_s']:.0f} s: {ended}"
