"""Fences: behind one, no answer to an earlier request can come any more.

A fence is a question whose answer no other question has had, which is the codec's to find. FACON has the
loopback (4E), which gives back a fresh nonce. All that comes before that answer is dropped, and only the
exact nonce brings the fence down: an older fence's echo does not. A protocol without such a question reads a
length that nothing else had; one that has none left, or does not know what was asked before, leaves it to
silence: for as long as a PLC may take, nothing must be heard. So it is with a PLC that refuses the fence.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.errors import FrameError, NoAnswer, PlcBusy, PlcError, PlcRefused, TransportError
from fatektool.exchange.no_answer import Account
from fatektool.protocol.codec import require_station
from fatektool.protocol.commands import Command, Loopback

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.errors import LineError
    from fatektool.exchange.link import Link
from fatektool.protocol.commands import Request


class Fences:
    """The fences of one link.

    Args:
        link: whose answers are to be told apart.
        nonces: gives nonces, never the same twice.
    """

    def __init__(self, link: Link, nonces: Callable[[], bytes]) -> None:
        self._link = link
        self._nonces = nonces
        self._asked: set[bytes] = set()  # the shapes of what was asked since the last fence
        self._inherited = False
        self._command: int = Command.LOOPBACK

    def inherit_doubt(self) -> None:
        """Somebody before left an answer on its way: to what question, nobody knows."""
        self._link.hearing.doubt = self._inherited = True

    def turn_to(self, station: int) -> None:
        """Ask another station from now on, on the same line.

        Raises:
            UsageError: no PLC can have this station.
        """
        link = self._link
        require_station(link.codec, station)
        link.station = station
        link.answered.clear()
        link.begin_with_echo()
        if link.hearing.turn_to(station):
            self.inherit_doubt()

    def note_asked(self, request: Request[Any]) -> None:
        """Remember a question whose answer may come at any time, until the next fence."""
        self._asked.add(self._link.codec.shape(request))

    def put_up(self, before: Request[Any] | None) -> None:
        """Ask until the fence's own answer comes; see ``Link.fence``."""
        if self._link.numbered:
            self._link.hearing.doubt = False  # what is owed may still come, and tells that this PLC is slow
        elif not self._by_question(before):
            self._hear_silence()

    def _by_question(self, before: Request[Any] | None) -> bool | None:
        """Ask until the fence's own answer comes.

        Returns:
            True if it came, False if it is refused, None if there is no such question.

        Raises:
            LineError: no answer.
        """
        link = self._link
        account = Account(link)
        failure: LineError | PlcError | None = None
        if before is not None:
            self.note_asked(before)
        fence = link.codec.probe
        for attempt in range(link.retries + 1):
            found = link.codec.fence(self._nonces(), None if self._inherited else self._asked)
            if found is None:
                return None
            fence = found
            self._command = fence.command
            try:
                if link.echoes is None and link.codec.echo_may_pass(fence):
                    link.learn_echo()
                account.tries += 1
                link.try_once(fence)
            except (TransportError, FrameError) as error:
                failure = error
                continue
            except PlcRefused as error:
                if isinstance(fence, Loopback):
                    return False
                link.hearing.doubt = True
                failure = error  # of a question before: an error code does not name its question either
                continue
            except PlcBusy as error:
                failure = error
                link.let_work(attempt)
                continue
            link.counters.fences += 1
            self._came_down()
            self.note_asked(fence)
            return True
        if isinstance(failure, PlcError):
            return False
        raise link.silence(fence, failure, account)

    def close(self) -> bool:
        """A fence behind the last of many requests; True if it proves their answers.

        A PLC that never answered a fence is let off with a note: with nothing astray before, what is lost is
        the proof, not the answers. With something astray, silence must do.
        """
        link = self._link
        link.hearing.drop_input()
        doubt = link.hearing.doubt
        if link.numbered:
            link.hearing.doubt = False
            return True
        try:
            came = self._by_question(None)
        except NoAnswer:
            if doubt or self._command in link.answered:
                raise
            came = False
        if came:
            return True
        if came is None or doubt:
            self._hear_silence()
        if came is None:
            return True
        link.note("this PLC answers no loopback (4E): a late answer to an earlier request could pass")
        self._came_down()
        return False

    def _hear_silence(self) -> None:
        """Wait until nothing comes for as long as a PLC may take.

        Raises:
            LineError: the line is never silent.
        """
        link = self._link
        probe = link.codec.probe
        account = Account(link)
        wire_s = (link.codec.request_bytes(probe) + link.codec.answer_bytes(probe)) * link.byte_time_s
        for _ in range(link.retries + 1):
            heard = link.counters.bytes_heard
            link.hearing.listen_until(link.transport.clock() + wire_s + link.wait_s)
            if link.counters.bytes_heard == heard:
                self._came_down()
                return
        raise link.silence(probe, None, account)

    def _came_down(self) -> None:
        self._link.hearing.fenced()
        self._asked.clear()
        self._inherited = False
