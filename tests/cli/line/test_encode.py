"""``encode``: the papers' frames from words, and back again through ``decode``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import UsageError
from fatektool.jobs.command_words import FORMS, MODBUS_FUNCTIONS, NAMES, parse_command
from fatektool.protocol.commands import Command
from fatektool.protocol.frames import answer_frame, frame
from fatektool.protocol.registry import codec_named
from tests.protocol import vectors
from tests.protocol.fatek.mseries import vectors as mseries_vectors
from tests.protocol.strategies import exchanges

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.commands import Request
    from fatektool.protocol.elements import Element
    from tests.cli.running import Cli

FACON = {
    "40": ("", "290000"),
    "41": ("run", "run"),
    "42": ("disable X16", "disable X16"),
    "43": ("Y10 7", "Y10:7=1,0,1,0,0,0,1"),
    "44": ("X50-X55", "X50:6=0,1,0,1,1,0"),
    "45": ("Y0:4=1,0,0,1", "Y0:4=1,0,0,1"),
    "46": ("R12 3", "R12:3=0x10A5,0x7FC4,1"),
    "47": ("WY8:2=0xAAAA,0x5555", "WY8:2=0xAAAA,0x5555"),
    "48": ("R1 Y9 DWM0", "R1=0x5C34 Y9=1 DWM0=0x003547BA"),
    "49": ("Y0=1 Y1=0 WM8=0x5555 DR2=0xFF", "Y0=1 Y1=0 WM8=0x5555 DR2=0xFF"),
    "4E": ("ABCDEFG", "ABCDEFG"),
}
"""The FACON paper's examples in words: the request, the answer."""


@pytest.mark.parametrize("code", FACON)
def test_the_papers_examples(cli: Cli, code: str) -> None:
    (example,) = [each for each in vectors.EXAMPLES if f"{each.request.command:02X}" == code]
    asks, answers = FACON[code]
    done = cli("encode", code, *asks.split())
    assert done.code == 0
    assert bytes.fromhex(done.out) == example.asks
    assert done.err.startswith("<02>01" + code)
    done = cli("encode", code, *answers.split(), "--as", "answer")
    assert bytes.fromhex(done.out) == example.answers


@pytest.mark.parametrize("example", mseries_vectors.EXAMPLES, ids=lambda example: example.name)
def test_the_m_series_examples_in_words(cli: Cli, example: vectors.Example) -> None:
    words = in_words(example.request)
    assert bytes.fromhex(cli("encode", *words, "--protocol", "mseries").out) == example.asks


def _run(request: Any, answer: Any) -> list[str]:
    return [str(request.first), str(request.count)] if answer is None else _values(request.first, answer)


def _values(first: Element, values: Any) -> list[str]:
    return [f"{first}:{len(values)}={','.join(str(int(value)) for value in values)}"]


def _mixed(request: Any, answer: Any) -> list[str]:
    if answer is None:
        return [str(element) for element in request.elements]
    return [f"{element}={value}" for element, value in zip(request.elements, answer, strict=True)]


WRITTEN: dict[Command, Callable[[Any, Any], list[str]]] = {
    Command.BRIEF_STATUS: lambda _, answer: [answer.to_bytes().hex()] if answer else [],
    Command.DETAILED_STATUS: lambda _, answer: [answer.raw.hex()] if answer else [],
    Command.RUN_STOP: lambda request, _: ["run" if request.run else "stop"],
    Command.CONTROL_DISCRETE: lambda request, _: [request.control.name.lower(), str(request.element)],
    Command.READ_DISABLED: _run,
    Command.READ_DISCRETES: _run,
    Command.READ_REGISTERS: _run,
    Command.WRITE_DISCRETES: lambda request, _: _values(request.first, request.values),
    Command.WRITE_REGISTERS: lambda request, _: _values(request.first, request.values),
    Command.READ_MIXED: _mixed,
    Command.WRITE_MIXED: lambda request, _: [f"{element}={value}" for element, value in request.items],
    Command.LOOPBACK: lambda request, _: [request.data.decode("latin-1")],
    Command.READ_PAGE: lambda request, answer: [str(request.page), *([answer.hex()] if answer else [])],
    Command.WRITE_PAGE: lambda request, _: [str(request.page), request.data.hex()],
}
"""A request, or with its answer the answer, as a user writes it: by this test's own hand."""


def in_words(request: Request[Any], answer: Any = None) -> list[str]:
    return [f"{request.command:02X}", *WRITTEN[request.command](request, answer)]


@given(exchanges)
def test_any_exchange_in_words(exchange: tuple[Request[Any], Any]) -> None:
    """Words -> request -> frame is the frame of the request itself, of answers too."""
    request, answer = exchange
    command, *words = in_words(request)
    assert frame(parse_command(command, *words).request) == frame(request)
    command, *words = in_words(request, answer)
    spoken = parse_command(command, *words, answer=True)
    assert answer_frame(spoken.request, spoken.answer) == answer_frame(request, answer)


@pytest.mark.parametrize("protocol", ["facon", "mseries", "modbus-rtu", "modbus-ascii", "modbus-tcp"])
def test_what_is_encoded_is_decoded(cli: Cli, protocol: str) -> None:
    modbus = protocol.startswith("modbus")
    lines = (
        ["01 Y0 8", "03 R12 3", "05 Y3=on", "06 D7=0xFFFF", "0F Y0:4=1,0,0,1", "10 R0:2=1,2", "46 R12 3"]
        if modbus
        else [
            f"{code} {asks}".strip()
            for code, (asks, _) in FACON.items()
            if protocol == "facon" or code != "4F"
        ]
    )
    for line in lines:
        for role in ("request", "answer"):
            words = line.split()
            if role == "answer" and not modbus:
                words = [words[0], *FACON[words[0]][1].split()]
            elif role == "answer":
                words = {"01": "01 Y0:8=1,0,0,0,0,0,0,1", "03": "03 R12:3=1,2,3", "46": "46 R12:3=1,2,3"}.get(
                    words[0], line
                ).split()
            ask = ("encode", *words, "--protocol", protocol, "--as", role, "-s", "17")
            built = cli(*ask, "--json").document("encode")
            assert built["frame"]["fault"] is None, words
            done = cli("decode", built["hex"], "--protocol", protocol, "--as", role, "--json")
            (shown,) = done.document("decode")["frames"]
            assert {name: shown[name] for name in built["frame"]} == built["frame"], words
            assert (shown["station"], shown["role"], shown["checksum_ok"]) == (
                17, role, None if protocol == "modbus-tcp" else True,
            )  # fmt: skip


@pytest.mark.parametrize("protocol", ["facon", "mseries"])
def test_a_command_that_no_paper_has(cli: Cli, protocol: str) -> None:
    built = cli("encode", "5A", "--data", "30 31", "--protocol", protocol, "--json").document("encode")
    assert (built["frame"]["command"], built["frame"]["checksum_ok"]) == ("5A", True)
    assert bytes.fromhex("3031") in bytes.fromhex(built["hex"])
    assert cli("encode", "5A", "--data", "-", "--protocol", protocol).code == 0


def test_refusals_are_answers(cli: Cli) -> None:
    assert cli("encode", "46", "--error", "A").out == "02 30 31 34 36 41 30 45 03\n"
    assert cli("encode", "03", "--error", "2", "--protocol", "modbus-tcp", "--number", "7").out == (
        "00 07 00 00 00 03 01 83 02\n"
    )


def test_quiet_leaves_the_hex_alone_and_verbose_explains(cli: Cli) -> None:
    assert cli("encode", "40", "-q") == (0, "02 30 31 34 30 43 37 03\n", "")
    done = cli("encode", "40", "-v")
    assert done.out == "02 30 31 34 30 43 37 03\n"
    assert "read brief status" in done.err
    assert "right" in done.err


def test_every_command_has_a_form_and_a_name() -> None:
    assert set(FORMS) == set(Command) == set(NAMES.values())
    assert set(MODBUS_FUNCTIONS.values()) <= set(FORMS)
    assert frame(parse_command("read-registers", "R12:3").request) == frame(
        parse_command("46", "R12-R14").request
    )


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("46", r"46 \(read registers\) takes ELEMENT COUNT, such as R12 3 or R12-R14; got nothing"),
        ("46 R12 3 4", "takes ELEMENT COUNT"),
        ("46 X0 3", "expected a register or word, got X0"),
        ("46 R12 65", "expected 1 to 64 elements, got 65"),
        ("47 R1", "takes ELEMENT:COUNT=VALUE"),
        ("45 X0=on Y1=on", "Y1: expected X1, the next address"),
        ("41 go", "takes run or stop; got go"),
        ("42 X16", "takes disable, enable, set or reset and an element"),
        ("48", "takes elements, such as"),
        ("4F x", "takes PAGE; got x"),
        ("50 1 00", "expected 128 bytes, got 1"),
        ("50 1 0", "expected hex digits in pairs"),
        ("zz", "expected a code in hex, such as 46, or one of brief-status"),
        ("5A", "5A is not documented; --data"),
        ("46 R1 --data 30", "--data and operands do not go together"),
        ("46 --data 30 --error A", "--error and --data do not go together"),
        ("46 --data 3", "expected hex digits in pairs"),
        ("46 --error zz", "expected a code in hex, such as A"),
        ("03 R1 -s 248 --protocol modbus-rtu", "station: expected 0 to 247, got 248"),
        ("46 R1 --number 3", "--number is for modbus-tcp"),
        ("04 R12 3 --protocol modbus-rtu", "asks this by 03, not 04; give 03, or the data field of 04"),
        ("03 R12 3", "in facon this is 46, not 03"),
        ("53 --protocol modbus-rtu", "Modbus has no such command"),
        ("46 --error 2 --protocol modbus-rtu", "expected a Modbus function"),
        ("40 2900 --as answer", "expected 3 bytes in hex, got 2"),
        ("53 2900 --as answer", "expected 64 bytes in hex, got 2"),
        ("46 R12 --as answer", r"the answer to 46 \(read registers\) takes ELEMENT:COUNT=VALUE"),
    ],
)
def test_what_cannot_be_said(cli: Cli, words: str, said: str) -> None:
    import re

    done = cli("encode", *words.split())
    assert (done.code, done.out) == (2, ""), done
    assert re.search(said, done.err), done.err


@given(
    st.sampled_from([*NAMES, "40", "46", "48", "03", "10", "5A", "FF", "0x4", "4h"]),
    st.lists(st.text(st.sampled_from("RDXYWM0123456789=:,-. onfi\x00é"), max_size=12), max_size=3),
    st.booleans(),
    st.sampled_from(["facon", "mseries", "modbus-rtu", "modbus-tcp"]),
)
def test_any_words_are_a_frame_or_refused(
    command: str, words: list[str], answer: bool, protocol: str
) -> None:
    """Whatever stands there: bytes that are one frame, or what was expected."""
    try:
        spoken = parse_command(command, *words, answer=answer)
        raw = (
            answer_frame(spoken.request, spoken.answer, 1, protocol)
            if answer
            else frame(spoken.request, 1, protocol)
        )
    except UsageError:
        return
    decoder = codec_named(protocol).decoder()
    decoder.feed(raw)
    found = decoder.next_frame()
    assert found is not None
    assert found.raw == raw
