"""``scan --network``: which Ethernet modules answer by UDP."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.line.documents.linetest import network_document
from fatektool.cli.line.frame_view import printable
from fatektool.cli.shared.pairs import apart, given
from fatektool.counts import counted
from fatektool.errors import UsageError
from fatektool.files.times import utc
from fatektool.transport import discovery

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.cli.shared.output import Voice
    from fatektool.transport.discovery import Answer

LISTENED_S = 2.0
_MOST_PORT = 65535
_IN_A_LINE = 16


def look_for_modules(voice: Voice, network: str, timeout_s: float) -> int:
    """Send a request to the address that is named, and to no other; show the answers.

    Args:
        voice: prints.
        network: HOST[:PORT].
        timeout_s: of ``--timeout``.

    Raises:
        UsageError: no such address, or an option that has no effect here.
        LineError: nothing can be sent.
    """
    apart(
        "network",
        *("port", "stations", "bauds", "formats", "protocols", "station", "baud", "line_format", "protocol"),
        *("old_format", "retries", "lock_wait", "low_latency", "trace", "inventory"),
        why="modules are found with one UDP request; --timeout is the time to wait for answers",
    )
    host, port = _host_and_port(network)
    listen_s = timeout_s if given("timeout") else LISTENED_S
    time = utc()
    shown = (lambda _: None) if voice.json else lambda answer: _show(voice, answer)
    found = discovery.discover(
        host, port, listen_s=listen_s, answer_port=discovery.ANSWER_PORT, on_answer=shown
    )
    if voice.json:
        voice.show(network_document(time, f"{host}:{port}", listen_s, found), ())
    count = len({answer.address for answer in found})
    modules = counted(count, "module") if count else "no modules"
    told = f"{modules} answered at {host}, UDP port {port}"
    advice = "; check the address, the network and the firewall" if not count else ""
    voice.say(f"{told}, within {listen_s:g} s{advice}")
    return 0 if found else 1


def _host_and_port(text: str) -> tuple[str, int]:
    host, colon, port = text.rpartition(":")
    if not colon or "]" in port or (":" in host and not host.startswith("[")):  # a bare IPv6 address
        host, port = text, str(discovery.MODULE_PORT)
    if not host or not (port.isascii() and port.isdigit() and 0 < int(port) <= _MOST_PORT):
        raise UsageError(f"--network: expected HOST or HOST:PORT, got {text!r:.80}")
    return host.strip("[]"), int(port)


def _show(voice: Voice, answer: Answer) -> None:
    voice.show({}, _lines(answer))


def _lines(answer: Answer) -> Iterator[str]:
    short = "" if len(answer.data) >= discovery.SHORTEST_ANSWER else ", shorter than that of a module"
    yield f"{answer.address}  {counted(len(answer.data), 'byte')}{short}; their meaning is not documented:"
    for at in range(0, len(answer.data), _IN_A_LINE):
        part = answer.data[at : at + _IN_A_LINE]
        yield f"  {at:04X}  {part.hex(' ').upper():<47}  {printable(part)}"


network_option = click.option(
    "--network",
    metavar="HOST[:PORT]",
    help="Instead: find Ethernet modules by UDP, at this address or broadcast address (192.168.2.255). "
    "Nothing is sent to other addresses.",
)
