"""Fences: behind one, no answer to an earlier request can come any more.

A fence is a request whose answer no other request can have had; the codec knows one. FACON has the loopback
(4E), which returns a fresh nonce. All that comes before that answer is dropped, and only the exact nonce
counts: the answer to an older fence does not. A protocol without such a request reads a length that nothing
else had. Where no length is left, or it is not known what was asked before, silence must do: for as long as a
PLC may take, nothing must be received. So it is with a PLC that refuses the fence.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.errors import FrameError, NoAnswer, PlcBusy, PlcError, PlcRefused, TransportError
from fatektool.exchange.no_answer import Effort, no_answer
from fatektool.protocol.codec import require_station
from fatektool.protocol.commands import Command, Loopback

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.errors import LineError
    from fatektool.exchange.attempts import Attempts
    from fatektool.exchange.receiver import Receiver
    from fatektool.exchange.sender import Sender
    from fatektool.exchange.state import LinkState
    from fatektool.protocol.commands import Request


class Fences:
    """The fences of one link.

    Args:
        state: of the link.
        receiver: its input.
        sender: its output.
        attempts: its tries.
        nonces: gives nonces, never the same twice.
        note: is told of a PLC that answers no fence.
    """

    def __init__(
        self,
        state: LinkState,
        receiver: Receiver,
        sender: Sender,
        attempts: Attempts,
        *,
        nonces: Callable[[], bytes],
        note: Callable[[str], None],
    ) -> None:
        self._state = state
        self._receiver = receiver
        self._sender = sender
        self._attempts = attempts
        self._nonces = nonces
        self._note = note
        self._unknown_before = False  # True if it is not known what was asked before
        self._command: int = Command.LOOPBACK

    def assume_outstanding_answer(self) -> None:
        """An answer to an earlier request may come; to which request is not known."""
        self._receiver.needs_fence = self._unknown_before = True

    def change_station(self, station: int) -> None:
        """Ask another station from now on, on the same line.

        Raises:
            UsageError: no PLC can have this station.
        """
        require_station(self._state.codec, station)
        may_come = self._receiver.change_station(station)
        self._state.change_station(station)
        if may_come:
            self.assume_outstanding_answer()

    def pass_one(self, before: Request[Any] | None) -> None:
        """Make sure that no answer to an earlier request can come any more.

        Args:
            before: what is asked next, if that is known: the fence's answer must not pass for its answer.

        Raises:
            NoAnswer: the PLC does not answer the fence.
            PlcRefused: it refuses it.
        """
        if self._state.numbered:
            self._receiver.needs_fence = False  # a late answer may still come, and shows that the PLC is slow
        elif not self._by_request(before):
            self._by_silence()

    def pass_last(self) -> bool:
        """A fence behind the last of many requests.

        A PLC that never answered a fence is excused with a note: if nothing unexpected came before, only the
        proof is missing, not the answers. If something did, silence must do.

        Returns:
            True if it proves their answers.

        Raises:
            NoAnswer: the PLC answered a fence before, and does not answer this one.
        """
        state, receiver = self._state, self._receiver
        receiver.drop_input()
        needed = receiver.needs_fence
        if state.numbered:
            receiver.needs_fence = False
            return True
        try:
            passed = self._by_request(None)
        except NoAnswer:
            if needed or self._command in state.answered:
                raise
            passed = False
        if passed:
            return True
        if passed is None or needed:
            self._by_silence()
        if passed is None:
            return True
        self._note("this PLC answers no loopback (4E): a late answer to an earlier request could pass")
        self._passed()
        return False

    def _by_request(self, before: Request[Any] | None) -> bool | None:
        """Send fences until the answer to the last one comes.

        Returns:
            True if it came, False if it is refused, None if there is no such request.

        Raises:
            LineError: no answer.
        """
        state, receiver, attempts = self._state, self._receiver, self._attempts
        effort = Effort(state)
        failure: LineError | PlcError | None = None
        if before is not None:
            self._sender.note_asked(before)
        fence = state.codec.probe
        for attempt in range(state.retries + 1):
            found = state.codec.fence(self._nonces(), None if self._unknown_before else self._sender.shapes)
            if found is None:
                return None
            fence = found
            self._command = fence.command
            try:
                if state.must_learn_echo(fence):
                    attempts.learn_echo()
                effort.tries += 1
                attempts.once(fence)
            except (TransportError, FrameError) as error:
                failure = error
                continue
            except PlcRefused as error:
                if isinstance(fence, Loopback):
                    return False
                receiver.needs_fence = True
                failure = error  # of an earlier request: an error code does not name its request either
                continue
            except PlcBusy as error:
                failure = error
                attempts.wait_while_busy(attempt)
                continue
            state.counters.fences += 1
            self._passed()
            self._sender.note_asked(fence)
            return True
        if isinstance(failure, PlcError):
            return False
        raise no_answer(state, receiver, fence, failure, effort)

    def _by_silence(self) -> None:
        """Wait until nothing comes for as long as a PLC may take.

        Raises:
            LineError: the line is never silent.
        """
        state, counters = self._state, self._state.counters
        probe = state.codec.probe
        effort = Effort(state)
        wire_s = (state.codec.request_bytes(probe) + state.codec.answer_bytes(probe)) * state.byte_time_s
        for _ in range(state.retries + 1):
            received = counters.bytes_received
            self._receiver.listen_until(state.transport.clock() + wire_s + state.wait_s)
            if counters.bytes_received == received:
                self._passed()
                return
        raise no_answer(state, self._receiver, probe, None, effort)

    def _passed(self) -> None:
        self._receiver.fence_passed()
        self._sender.shapes.clear()
        self._unknown_before = False
