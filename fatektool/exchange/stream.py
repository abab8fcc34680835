"""The fast way through many requests: as long as all is in order, and not one exchange longer.

An answer to a read sends the next request off as soon as it has the right length, and is looked at while the
PLC is at work on that. A write goes out only when the one before it is acknowledged, but is encoded by then::

    reads     request n+1 ─>  look at answer n, encode request n+2  <─ answer n+1
    writes    request n   ─>  encode request n+1  <─ answer n, look at it

The first sign of anything else (a time-out, a wrong length or checksum, input beside the answer, an error
code) ends it. The request that is on its way then is given up, and whoever called goes on with ``Link.ask``,
behind a fence.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from fatektool.errors import FrameError, PlcBusy, PlcRefused, TransportError, TransportTimeout

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fatektool.exchange.link import Link
    from fatektool.exchange.sent import Sent
    from fatektool.protocol.codec import Frame
    from fatektool.protocol.commands import Request

A = TypeVar("A")

_READ_BYTES = 4096


def ask_in_stream(link: Link, requests: Sequence[Request[A]], first: int, take: Callable[[A], None]) -> bool:
    """Ask one after the other from ``requests[first]``, until the end or the first sign of disorder.

    Args:
        link: the line.
        requests: all reads, or all writes.
        first: the one to begin with.
        take: is given each answer, in order.

    Returns:
        True if the request behind the last answer was sent, and what became of it is not known.

    Raises:
        PlcRefused: a write is refused; of a read, the caller hears it by asking again.
        LineReadOnly: they write, and the line may only be read.
    """
    receiver = link.receiver
    if receiver.drop_input() or receiver.needs_fence or link.echoes is not False:
        return False
    steps = _write_by_write if requests[first].writes else _read_ahead
    try:
        return steps(link, requests, first, take)
    except TransportError:
        receiver.note_no_answer()
        return True
    except PlcRefused:
        raise
    except BaseException:  # an interrupt: the answer may still come
        receiver.note_no_answer()
        raise


def _read_ahead(link: Link, requests: Sequence[Request[A]], first: int, take: Callable[[A], None]) -> bool:
    receiver = link.receiver
    last = len(requests) - 1
    asked = sent = link.sender.prepare(requests[first])
    waiting: bytes | None = None  # the last answer, not yet looked at
    for place in range(first, len(requests)):
        link.sender.send(sent)
        link.counters.exchanges += 1
        if waiting is not None and not _accept(link, requests[place - 1], asked, waiting, take):
            receiver.give_up_answer()
            return True
        asked = sent
        if place < last:
            sent = link.sender.prepare(requests[place + 1])
        received = _receive(link, asked)
        link.sender.note_end()
        if received is None:
            return True
        if isinstance(received, bytes):
            waiting = received
        elif _accept(link, requests[place], asked, received, take):
            waiting = None
        else:  # a refusal, mostly: nothing is sent behind it whose answer nobody would wait for
            return True
        if receiver.drop_input():
            break
    return waiting is not None and not _accept(link, requests[place], asked, waiting, take)


def _write_by_write(
    link: Link, requests: Sequence[Request[A]], first: int, take: Callable[[A], None]
) -> bool:
    receiver = link.receiver
    sent = link.sender.prepare(requests[first])
    for place in range(first, len(requests)):
        asked = sent
        link.sender.send(asked)
        link.counters.exchanges += 1
        if place + 1 < len(requests):
            sent = link.sender.prepare(requests[place + 1])
        waiting = _receive(link, asked)
        link.sender.note_end()
        if waiting is None:
            return True
        more = receiver.drop_input()
        if not _accept(link, requests[place], asked, waiting, take):
            receiver.note_no_answer()
            return True
        if more:
            break
    return False


def _receive(link: Link, sent: Sent) -> Frame | bytes | None:
    """Bytes of the answer's length, not looked at; a frame, if one came before; else None, and a doubt."""
    receiver, transport = link.receiver, link.transport
    size = sent.size
    rest = wait_s = (len(sent.raw) + size) * link.byte_time_s + link.state.wait_s
    began = transport.clock()
    whole = b""
    looked = False
    while rest > 0 or not looked:  # what has come in time counts, however late this process looks
        looked = rest <= 0
        try:
            data = transport.read(_READ_BYTES, max(0.0, rest))
        except TransportTimeout:
            data = b""
        link.counters.bytes_received += len(data)
        whole += data
        if len(whole) == size:  # to send what comes next is more urgent than to look at it
            receiver.decoder.clear()
            return whole
        receiver.decoder.feed(data)
        try:
            frame = receiver.decoder.next_frame()
        except FrameError as error:
            receiver.note_bad_bytes(error)
            receiver.give_up_answer()
            return None
        if frame is not None:
            return frame
        rest = began + wait_s - transport.clock()
    link.counters.timeouts += 1
    receiver.note_no_answer()
    return None


def _accept(
    link: Link, request: Request[A], sent: Sent, waiting: Frame | bytes, take: Callable[[A], None]
) -> bool:
    """Look at an answer; True if it is what the request asked for.

    Raises:
        PlcRefused: a write is refused.
    """
    receiver = link.receiver
    frame: Frame | None = None
    try:
        if isinstance(waiting, bytes):
            receiver.decoder.feed(waiting)
            frame = receiver.decoder.next_frame()
        else:
            frame = waiting
        if frame is None:
            return False
        if sent.answered_by(frame):
            take(link.codec.parse_answer(request, frame))
            link.state.answered.add(request.command)
            return True
    except FrameError as error:
        if frame is None:
            receiver.note_bad_bytes(error)
            return False
    except PlcRefused:
        if request.writes:
            raise
        return False
    except PlcBusy:  # to be asked again, with pauses
        return False
    receiver.note_stray(frame)
    return False
