"""The contract of a transport, over every medium with real sockets and terminals."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import TransportClosed, TransportTimeout
from fatektool.transport.udp import UdpTransport
from tests.platforms import under_wine
from tests.transport.media import MEDIA, PATIENCE_S, ask_twice

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from contextlib import AbstractContextManager

    from tests.transport.media import Medium


@pytest.fixture(params=MEDIA)
def medium(request: pytest.FixtureRequest) -> Iterator[Medium]:
    make: Callable[[], AbstractContextManager[Medium]] = request.param
    with make() as made:
        yield made


def read_all(medium: Medium, count: int) -> bytes:
    data = b""
    while len(data) < count:
        more = medium.transport.read(4096, PATIENCE_S)
        assert more
        data += more
    return data


def test_what_the_other_side_sends_is_read(medium: Medium) -> None:
    every_byte = bytes(range(256))
    medium.send(every_byte)
    assert read_all(medium, 256) == every_byte


def test_a_read_takes_no_more_than_asked_but_a_datagram_whole(medium: Medium) -> None:
    medium.send(b"\x0201\x03")
    first = medium.transport.read(1, PATIENCE_S)
    if medium.whole:
        assert first == b"\x0201\x03"
        return
    assert first == b"\x02"
    assert read_all(medium, 3) == b"01\x03"


@pytest.mark.parametrize("timeout_s", [0.01, 0.0, -1.0])
def test_silence_is_a_timeout(medium: Medium, timeout_s: float) -> None:
    with pytest.raises(TransportTimeout) as caught:
        medium.transport.read(16, timeout_s)
    assert medium.transport.name in caught.value.message
    medium.send(b"later")  # and the medium is as good as before
    assert read_all(medium, 5) == b"later"


def test_a_wait_of_years_is_no_error(medium: Medium) -> None:
    medium.send(b"soon")
    assert medium.transport.read(16, 1e9)


def test_what_is_written_arrives_whole(medium: Medium) -> None:
    medium.transport.write(b"\x020140C3\x03")
    assert medium.receive(8) == b"\x020140C3\x03"


def test_a_large_write_arrives_whole(medium: Medium) -> None:
    data = bytes(range(256)) * (medium.most // 256)
    heard: list[bytes] = []
    listener = threading.Thread(target=lambda: heard.append(medium.receive(len(data))))
    if medium.transport.name == "sim:":  # the other side is this thread
        medium.transport.write(data)
        listener.start()
    else:
        listener.start()
        medium.transport.write(data)
    listener.join(PATIENCE_S)
    assert heard == [data]


def test_drain_takes_what_is_there(medium: Medium) -> None:
    assert medium.transport.drain() == b""
    medium.send(b"first")
    medium.send(b"second")
    got = medium.transport.read(1, PATIENCE_S)
    while len(got) < len("firstsecond"):
        got += medium.transport.drain() or medium.transport.read(1, PATIENCE_S)
    assert got == b"firstsecond"
    assert medium.transport.drain() == b""


def test_closing_twice_is_fine(medium: Medium) -> None:
    medium.send(b"unread")
    medium.transport.close()
    medium.transport.close()
    assert medium.transport.drain() == b""
    with pytest.raises(TransportClosed):
        medium.transport.read(16, 0.01)


def test_a_context_closes(medium: Medium) -> None:
    with medium.transport as entered:
        assert entered is medium.transport
    with pytest.raises(TransportClosed):
        medium.transport.read(16, 0.01)


def test_the_other_side_goes(medium: Medium) -> None:
    if under_wine() and isinstance(medium.transport, UdpTransport):
        pytest.skip("not in Wine: an unreachable UDP port is not reported")
    medium.hang_up()
    name = medium.transport.name
    with pytest.raises(TransportClosed) as caught:
        ask_twice(medium.transport)
    message = str(caught.value)
    assert name in message
    assert "\n" not in message
    if medium.transport.name != "sim:":
        assert caught.value.hint
    assert medium.transport.drain() == b""


def test_draining_after_the_other_side_went_is_quiet(medium: Medium) -> None:
    medium.hang_up()
    for _ in range(3):
        assert medium.transport.drain() == b""


def test_renewal_leaves_a_medium_that_can_be_written(medium: Medium) -> None:
    medium.transport.renew()
    medium.transport.write(b"again")
    medium.transport.renew()
    medium.transport.close()
