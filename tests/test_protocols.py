"""One table says what a protocol is; each row has all of its parts, and they work together."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

import pytest

from fatektool.address import DEFAULT_FORMATS, default_format
from fatektool.protocol.explain import FrameRole
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.protocol.fatek.mseries.codec import MSERIES
from fatektool.protocol.modbus.ascii import ASCII
from fatektool.protocol.modbus.rtu import RTU
from fatektool.protocol.modbus.tcp import TCP
from fatektool.protocol.registry import CODECS, codec_named, new_explainer
from fatektool.protocols import DEFAULT, PROTOCOLS
from fatektool.simulator.build import build_plcs
from fatektool.simulator.slaves.base import SlaveType
from fatektool.simulator.slaves.registry import SLAVES
from tests.test_imports import trees

if TYPE_CHECKING:
    from fatektool.protocol.codec import Codec

TYPED: list[Codec] = [FACON, MSERIES, RTU, ASCII, TCP]
"""The table names its parts as text; that each is a codec, the type checker proves here."""

each_protocol = pytest.mark.parametrize("name", PROTOCOLS)


def test_the_codecs_are_those_that_were_checked() -> None:
    assert list(CODECS.values()) == TYPED
    assert [codec.name for codec in TYPED] == list(PROTOCOLS) == list(SLAVES)
    assert DEFAULT in PROTOCOLS


@each_protocol
def test_each_side_has_its_own_parts(name: str) -> None:
    parts = PROTOCOLS[name]
    assert parts.codec.startswith("fatektool.protocol.")
    assert parts.explainer.startswith("fatektool.protocol.")
    assert parts.slave.startswith("fatektool.simulator.slaves.")
    assert isinstance(SLAVES[name], SlaveType)


@each_protocol
def test_the_parts_of_a_protocol_understand_each_other(name: str) -> None:
    """What the codec encodes, the slave answers, the codec parses and the explainer explains."""
    codec, slave = codec_named(name), SLAVES[name]
    line = slave.make(build_plcs([7], slave.model))
    asked = codec.encode(7, codec.probe)
    (request,) = line.cut(asked)
    answered = line.answer(request)
    assert answered is not None
    assert len(asked) == codec.request_bytes(codec.probe)
    assert len(answered) == codec.answer_bytes(codec.probe)
    decoder = codec.decoder()
    decoder.feed(answered)
    frame = decoder.next_frame()
    assert frame is not None
    assert (frame.station, frame.command) == (7, codec.code(codec.probe))
    codec.parse_answer(codec.probe, frame)
    explainer = new_explainer(name)
    assert explainer.form
    for raw, role in ((asked, FrameRole.REQUEST), (answered, FrameRole.ANSWER)):
        (shown,) = explainer.explain(raw, role)
        assert (shown.role, shown.raw, shown.station, shown.fault) == (role, raw, 7, None)


def test_no_number_of_a_trace_is_used_twice() -> None:
    codes = [parts.trace_code for parts in PROTOCOLS.values()]
    assert len(set(codes)) == len(codes)
    assert all(0 < code < 256 for code in codes)


@each_protocol
def test_the_help_names_the_format_of_each(name: str) -> None:
    """Of those on serial lines; the slave's lines have the same."""
    if codec_named(name).data_bits is None:
        assert name not in DEFAULT_FORMATS
        return
    usual, _, exceptions = DEFAULT_FORMATS.partition(";")
    wanted = exceptions.split()[0] if name in exceptions.split() else usual
    assert default_format(codec_named(name)) == wanted
    assert SLAVES[name].bits_per_char == {"7E1": 10, "8E1": 11}[wanted]


def test_there_is_no_other_list() -> None:
    """A module that names three protocols has a list of its own."""
    for module, tree in trees():
        named = {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)} & PROTOCOLS.keys()
        if module != "fatektool.protocols":
            assert len(named) < 3, f"{module}: {named}"
