from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import UsageError
from fatektool.transport.base import LineSettings
from fatektool.transport.target import Target, TargetKind

SERIAL, TCP, UDP, SIM = TargetKind.SERIAL, TargetKind.TCP, TargetKind.UDP, TargetKind.SIM


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("/dev/ttyUSB0", (SERIAL, "", 0, "/dev/ttyUSB0")),
        ("/dev/serial/by-id/usb-FTDI_FT232R-if00-port0", (SERIAL, "", 0, None)),
        ("ttyUSB0", (SERIAL, "", 0, "ttyUSB0")),
        ("COM3", (SERIAL, "", 0, "COM3")),
        (r"\\.\COM12", (SERIAL, "", 0, r"\\.\COM12")),
        ("rfc2217://gateway:4001", (SERIAL, "", 0, "rfc2217://gateway:4001")),
        ("socket://gateway:4001", (SERIAL, "", 0, "socket://gateway:4001")),
        ("spy:///dev/ttyUSB0?file=log", (SERIAL, "", 0, "spy:///dev/ttyUSB0?file=log")),
        ("loop://", (SERIAL, "", 0, "loop://")),
        ("tcp://plc", (TCP, "plc", 500, "")),
        ("tcp://plc/", (TCP, "plc", 500, "")),
        ("tcp://192.168.2.3:501", (TCP, "192.168.2.3", 501, "")),
        ("tcp://plc-3.works.example:65535", (TCP, "plc-3.works.example", 65535, "")),
        ("tcp://[::1]", (TCP, "::1", 500, "")),
        ("tcp://[::1]:1", (TCP, "::1", 1, "")),
        ("tcp://[fe80::1%eth0]:502", (TCP, "fe80::1%eth0", 502, "")),
        ("udp://plc", (UDP, "plc", 500, "")),
        ("udp://plc:0500", (UDP, "plc", 500, "")),
        ("udp://[2001:db8::1]:9", (UDP, "2001:db8::1", 9, "")),
        ("sim:", (SIM, "", 0, "")),
        ("sim:plc.json", (SIM, "", 0, "plc.json")),
        ("sim:/var/lib/plc 1.json", (SIM, "", 0, "/var/lib/plc 1.json")),
    ],
)
def test_every_form(text: str, expected: tuple[TargetKind, str, int, str | None]) -> None:
    target = Target.parse(text)
    kind, host, port, path = expected
    assert target == Target(text, kind, host, port, text if path is None else path)
    assert target.is_url is (kind is SERIAL and "://" in text)


@pytest.mark.parametrize(
    "text",
    [
        "",
        " \t",
        "a\0b",
        "sim:\0",
        "tcp://a\0b",
        "tcp:",
        "tcp://",
        "tcp:/plc",
        "tcp:plc",
        "tcp://:500",
        "tcp://plc:",
        "tcp://plc:0",
        "tcp://plc:65536",
        "tcp://plc:" + "9" * 5000,
        "tcp://plc:-1",
        "tcp://plc:5 00",
        "tcp://plc:\u0665",
        "tcp://::1",
        "tcp://[::1",
        "tcp://[]",
        "tcp://me@plc",
        "tcp://plc/program",
        "tcp://plc?x",
        "udp://plc:http",
    ],
)
def test_what_is_no_target(text: str) -> None:
    with pytest.raises(UsageError) as caught:
        Target.parse(text)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 6000


targets = st.text() | st.builds(
    "".join,
    st.lists(
        st.sampled_from(
            ["tcp:", "udp:", "sim:", "/", "//", "[", "]", ":", "::1", "plc", "500", "%", "@", "\n"]
        )
        | st.text(max_size=3),
        max_size=8,
    ),
)


@given(targets)
def test_a_target_or_a_usage_error(text: str) -> None:
    try:
        target = Target.parse(text)
    except UsageError:
        return
    assert target.text == text
    if target.kind in {TCP, UDP}:
        assert target.host
        assert 1 <= target.port <= 65535
        assert not target.path
    else:
        assert not target.host
        assert target.path or text == "sim:"


@pytest.mark.parametrize(
    ("baud", "form", "bits"),
    [
        (9600, "7E1", 10),
        (9600, "8N1", 10),
        (50, "5N1", 7),
        (4_000_000, "8M2", 12),
        (115200, "8E1.5", 11.5),
        (921600, "6S1", 9),
        (19200, "7O2", 11),
        (9600, "7e1", 10),
    ],
)
def test_line_settings(baud: int, form: str, bits: float) -> None:
    line = LineSettings(baud, form)
    assert str(line) == f"{baud} {form.upper()}"
    assert f"{line.data_bits}{line.parity}{line.stop_bits:g}" == form.upper()
    assert line.byte_time_s == pytest.approx(bits / baud)


def test_the_factory_setting() -> None:
    assert str(LineSettings()) == "9600 7E1"


@pytest.mark.parametrize("baud", [0, -9600, 49, 4_000_001])
def test_a_speed_that_no_line_has(baud: int) -> None:
    with pytest.raises(UsageError, match=f"baud: .* got {baud}"):
        LineSettings(baud)


@pytest.mark.parametrize(
    "form",
    [
        "",
        "7",
        "7E",
        "E71",
        "9N1",
        "4N1",
        "8X1",
        "8N3",
        "8N0",
        "8N1 ",
        " 8N1",
        "8N1\n",
        "8N11",
        "\u0668N1",
    ],
)
def test_a_format_that_no_line_has(form: str) -> None:
    with pytest.raises(UsageError, match="format: expected data bits"):
        LineSettings(9600, form)


@given(st.integers(), st.text() | st.from_regex(r"[4-9][NEOMSX](1|1\.5|2|3)", fullmatch=True))
def test_line_settings_or_a_usage_error(baud: int, form: str) -> None:
    try:
        line = LineSettings(baud, form)
    except UsageError:
        return
    assert 0 < line.byte_time_s < 1


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("TCP://plc", "tcp://plc"),
        ("Udp://PLC:7", "udp://PLC:7"),
        ("SIM:Plc.state", "sim:Plc.state"),
        ("Socket://GW:1", "socket://GW:1"),
        ("MODEM:COM3?number=1", "modem:COM3?number=1"),
    ],
)
def test_a_scheme_in_capitals(written: str, meant: str) -> None:
    """As in any URL; what stands behind it is left as it is written."""
    assert Target.parse(written) == Target.parse(meant)
