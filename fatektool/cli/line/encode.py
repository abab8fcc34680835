"""``encode``: a frame from a command in words."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.line.documents.frames import encode_document
from fatektool.cli.line.frame_view import characters, field_lines
from fatektool.cli.shared.options import ChoiceType, voice_options
from fatektool.errors import UsageError
from fatektool.jobs.command_operands import parse_hex
from fatektool.jobs.command_words import MODBUS_FUNCTIONS, parse_code, parse_command
from fatektool.protocol.explain import FrameRole
from fatektool.protocol.frames import answer_frame, error_frame, frame, raw_frame
from fatektool.protocol.registry import codec_named, new_explainer
from fatektool.protocols import DEFAULT, PROTOCOLS

if TYPE_CHECKING:
    from fatektool.cli.shared.output import Voice
    from fatektool.protocol.explain import Explainer, Explanation

_ROLES = {"request": FrameRole.REQUEST, "answer": FrameRole.ANSWER}
_TCP = "modbus-tcp"


@click.command(
    "encode",
    epilog="Examples: fatektool encode 46 R12 3;  fatektool encode 03 R12 3 --protocol modbus-rtu",
)
@click.argument("command")
@click.argument("operands", nargs=-1, metavar="[OPERANDS]…")
@click.option("--protocol", type=ChoiceType(PROTOCOLS), default=DEFAULT, show_default=True)
@click.option("-s", "--station", metavar="N", type=click.IntRange(0, 255), default=1, show_default=True)
@click.option(
    "--as",
    "role",
    type=click.Choice(list(_ROLES)),
    default="request",
    show_default=True,
    help="Write an answer as its request, with the values that it returns.",
)
@click.option("--error", metavar="CODE", help="The answer that refuses COMMAND with this error code, in hex.")
@click.option("--data", metavar="HEX", help="The data field in hex, for any COMMAND; - for an empty one.")
@click.option(
    "--number", type=click.IntRange(0, 0xFFFF), metavar="N", help=f"Number of a {_TCP} frame.  [default: 0]"
)
@voice_options
def encode_command(
    command: str,
    operands: tuple[str, ...],
    voice: Voice,
    *,
    protocol: str,
    station: int,
    role: str,
    error: str | None,
    data: str | None,
    number: int | None,
) -> None:
    """Build the frame of a COMMAND, checksum included, and print it in hex. Nothing is sent.

    COMMAND is a code in hex or a name (read-registers); with Modbus also a function (01 to 06, 0F, 10). The
    hex goes to stdout, the characters of an ASCII frame to stderr, with -v each field too.

    \b
    40, 53     nothing             44, 43, 46  ELEMENT COUNT
    41         run or stop         45, 47      ELEMENT:COUNT=VALUE,VALUE…
    42         enable, disable,    48          ELEMENT…
               set or reset, and   49          ELEMENT=VALUE…
               ELEMENT             4E          TEXT
    4F         PAGE                50          PAGE and 128 bytes in hex
    """  # noqa: D301  # click's mark for lines to be kept is the control character itself
    if number is not None and codec_named(protocol).numbers == 1:
        raise UsageError(f"--number is for {_TCP}: {protocol} frames have none")
    given = [name for name, value in (("--error", error), ("--data", data)) if value is not None]
    if len(given) > 1 or (given and operands):
        with_what = " and ".join(given) if len(given) > 1 else f"{given[0]} and operands"
        raise UsageError(f"{with_what} do not go together")
    answer = role == "answer" or error is not None
    place: dict[str, Any] = {"station": station, "protocol": protocol, "number": number or 0}
    if error is not None:
        raw = error_frame(_wire_code(command, protocol), _code(error), **place)
    elif data is not None:
        content = b"" if data == "-" else parse_hex(data)
        raw = raw_frame(parse_code(command), content, answer=answer, **place)
    else:
        raw = _encoded(command, operands, answer=answer, **place)
    explainer = new_explainer(protocol)
    shown = _explained(explainer, raw, FrameRole.ANSWER if answer else FrameRole.REQUEST)
    voice.show(encode_document(protocol, raw, shown), [raw.hex(" ").upper()])
    if voice.json:
        return
    if not explainer.binary:
        voice.say(characters(raw))
    for line in field_lines(shown, binary=explainer.binary):
        voice.detail(line)


def _encoded(
    command: str, operands: tuple[str, ...], *, answer: bool, protocol: str, station: int, number: int
) -> bytes:
    """A request or answer that the protocol has."""
    spoken = parse_command(command, *operands, answer=answer, m_series=protocol == "mseries")
    if answer:
        raw = answer_frame(spoken.request, spoken.answer, station, protocol, number=number)
    else:
        raw = frame(spoken.request, station, protocol, number=number)
    code = parse_code(command)
    function = codec_named(protocol).code(spoken.request)
    if code in MODBUS_FUNCTIONS and code != function:
        what = f"{protocol} asks this by" if protocol.startswith("modbus-") else f"in {protocol} this is"
        raise UsageError(
            f"command: {what} {function:02X}, not {code:02X}",
            hint=f"give {function:02X}, or the data field of {code:02X} with --data",
        )
    return raw


def _wire_code(command: str, protocol: str) -> int:
    """The code of a command to be refused; of Modbus the function, as a name may be one of several."""
    code = parse_code(command)
    if protocol.startswith("modbus-") and code not in MODBUS_FUNCTIONS and code >= 0x40:
        raise UsageError(
            f"--error: expected a Modbus function as command, such as 03, got {command}",
            hint="'fatektool encode' without --error shows which function asks for an element",
        )
    return code


def _code(text: str) -> int:
    try:
        return int(text, 16)
    except ValueError:
        raise UsageError(f"--error: expected a code in hex, such as A, got {text!r:.20}") from None


def _explained(explainer: Explainer, raw: bytes, role: FrameRole) -> Explanation:
    """The fields of a frame; the first explanation is of all of it, as it is whole."""
    return next(iter(explainer.explain(raw, role)))
