"""``decode``: hex in every spelling, traces, and what is neither."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.cli.running import check

if TYPE_CHECKING:
    from pathlib import Path

    from tests.cli.running import Cli

STATUS = bytes.fromhex("0230313430433703")


@pytest.mark.parametrize(
    "words",
    [
        ["02 30 31 34 30 43 37 03"],
        ["02", "30", "31", "34", "30", "43", "37", "03"],
        ["0230313430433703"],
        ["0x02", "0x30,", "0x31,0x34", "0X30 0x43;0x37", "0x03"],
        ["02:30:31:34:30:43:37:03"],
        ["02-30-31-34-30-43-37-03"],
        ["02 30 31 34", "30 43 37 03"],
    ],
)
def test_hex_in_every_spelling(cli: Cli, words: list[str]) -> None:
    (frame,) = cli("decode", "--json", "--", *words).document("decode")["frames"]
    assert frame["raw"] == STATUS.hex().upper()
    assert (frame["station"], frame["command"], frame["checksum_ok"]) == (1, "40", True)


def test_a_wrong_checksum_is_shown(cli: Cli) -> None:
    done = cli("decode", STATUS.hex().replace("4337", "4338"))
    assert done.code == 5
    assert "WRONG: expected C7" in done.out
    assert done.err == "warning: 1 of 1 frame damaged\n"


def test_what_a_frame_is_can_be_said(cli: Cli) -> None:
    for role in ("request", "answer"):
        (frame,) = cli("decode", STATUS.hex(), "--as", role, "--json").document("decode")["frames"]
        assert frame["role"] in {role, "broken"}


@pytest.mark.parametrize(
    "content",
    [b"", b"\n\n", b"\xa1\xb2\xc3\xd4", b"\x4d\x3c\xb2\xa1" + b"\0" * 10, b"{}", b"\xff" * 99, b"[" * 9999],
)
def test_a_trace_that_is_none(place: Path, cli: Cli, content: bytes) -> None:
    (place / "line.pcap").write_bytes(content)
    done = cli("decode", "line.pcap")
    assert done.code == 5
    assert done.out == ""
    assert done.err.count("\n") == 1


def test_a_trace_with_no_frame_in_it(place: Path, cli: Cli) -> None:
    (place / "x.ndjson").write_text('{"time": "2026-11-22T03:15:00Z", "direction": "rx", "hex": "FF"}\n')
    assert cli("decode", "x.ndjson").code == 5


def test_a_folder_is_no_trace(place: Path, cli: Cli) -> None:
    (place / "traces").mkdir()
    assert cli("decode", "traces").code == 2


@given(st.binary(min_size=1, max_size=80))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_bytes_are_explained_or_refused(cli: Cli, data: bytes) -> None:
    done = cli("decode", data.hex(), "--json")
    assert done.code in {0, 5}
    document = json.loads(done.out)
    check(document, "decode" if "frames" in document else "error")
    if "frames" in document:
        assert done.code == (5 if any(frame["fault"] for frame in document["frames"]) else 0)
    framed = b"\x02" + data.replace(b"\x03", b"") + b"\x03"
    assert cli("decode", framed.hex()).code in {0, 5}


@pytest.mark.parametrize("name", ["x.pcap", "x.ndjson"])
def test_a_trace_tells_its_protocol(cli: Cli, name: str) -> None:
    assert cli("status", "-p", "sim:", "--protocol", "mseries", "--trace", name).code == 0
    found = cli("decode", name, "--json").document("decode")
    assert found["protocol"] == "mseries"
    assert all(frame["checksum_ok"] for frame in found["frames"])
    assert cli("decode", name, "--protocol", "facon").code == 5


def test_a_trace_that_does_not_tell_is_facon(cli: Cli, place: Path) -> None:
    line = '{"time": "2026-11-22T03:15:00Z", "direction": "tx", "hex": "0230313430433703"}\n'
    for protocol in ("", '"protocol": "x", ', '"protocol": 7, '):
        (place / "x.ndjson").write_text(line.replace('"direction"', protocol + '"direction"'))
        assert cli("decode", "x.ndjson", "--json").document("decode")["protocol"] == "facon"
