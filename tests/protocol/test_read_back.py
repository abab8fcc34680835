"""How a write whose answer was lost is looked for."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given

from fatektool.protocol.commands import (
    Control,
    ControlDiscrete,
    ReadBriefStatus,
    ReadDisabled,
    ReadDiscretes,
    ReadMixed,
    ReadPage,
    ReadRegisters,
    Request,
    RunStop,
    WriteDiscretes,
    WriteMixed,
    WritePage,
    WriteRegisters,
)
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.protocol.read_back import read_back
from fatektool.protocol.status import BriefStatus, StatusFlags
from tests.protocol.strategies import requests

X16, R12, DR2 = Element("X", 16), Element("R", 12), Element("DR", 2)
PAGE = bytes(range(128))
RUNNING, STOPPED = (BriefStatus(StatusFlags.parse(byte), 0, 0) for byte in (1, 0))


@pytest.mark.parametrize(
    ("write", "question", "took", "did_not"),
    [
        (RunStop(run=True), ReadBriefStatus(), RUNNING, STOPPED),
        (RunStop(run=False), ReadBriefStatus(), STOPPED, RUNNING),
        (ControlDiscrete(Control.DISABLE, X16), ReadDisabled(X16, 1), (True,), (False,)),
        (ControlDiscrete(Control.ENABLE, X16), ReadDisabled(X16, 1), (False,), (True,)),
        (ControlDiscrete(Control.SET, X16), ReadDiscretes(X16, 1), (True,), (False,)),
        (ControlDiscrete(Control.RESET, X16), ReadDiscretes(X16, 1), (False,), (True,)),
        (WriteDiscretes(X16, (True, False)), ReadDiscretes(X16, 2), (True, False), (True, True)),
        (WriteRegisters(R12, (1, 2)), ReadRegisters(R12, 2), (1, 2), (1, 3)),
        (WriteMixed(((DR2, 7), (X16, 1))), ReadMixed((DR2, X16)), (7, 1), (7, 0)),
        (WritePage(5, PAGE), ReadPage(5), PAGE, PAGE[::-1]),
    ],
)
def test_question_and_test(write: Request[None], question: Request[Any], took: Any, did_not: Any) -> None:
    asked, test = read_back(write)
    assert asked == question
    assert test(took) is True
    assert test(did_not) is False


@given(requests.filter(lambda request: request.writes))
def test_what_any_write_wrote_can_be_asked(request: Request[None]) -> None:
    question, _ = read_back(request)
    assert not question.writes
    assert FACON.encode(1, question)


@given(requests.filter(lambda request: not request.writes))
def test_a_read_wrote_nothing(request: Request[None]) -> None:
    with pytest.raises(TypeError, match="writes nothing"):
        read_back(request)
