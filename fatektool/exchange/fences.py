"""Fences: after one, no answer to an earlier request can be received any more.

A fence is a request whose answer differs from the answer to every other request. FACON has the loopback (4E),
which returns a new nonce. Everything received before that answer is dropped, and only the exact nonce counts,
so the answer to an older fence does not. A protocol without such a request reads a length that no other
request had. If no length is left, or the earlier requests are not known, or the PLC refuses the fence, then
silence is used instead: nothing must be received for as long as a PLC may take.
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
        nonces: returns nonces, never the same twice.
        note: gets a message if the PLC answers no fence.
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
        self._unknown_before = False  # True if the earlier requests are not known
        self._command: int = Command.LOOPBACK

    def assume_outstanding_answer(self) -> None:
        """An answer to an earlier, unknown request may be received."""
        self._receiver.needs_fence = self._unknown_before = True

    def change_station(self, station: int) -> None:
        """Send requests to another station from now on, on the same line.

        Raises:
            UsageError: no PLC can have this station.
        """
        require_station(self._state.codec, station)
        may_come = self._receiver.change_station(station)
        self._state.change_station(station)
        if may_come:
            self.assume_outstanding_answer()

    def pass_one(self, before: Request[Any] | None) -> None:
        """Make sure that no answer to an earlier request can be received any more.

        Args:
            before: the next request, if known: the fence's answer must differ from its answer.

        Raises:
            NoAnswer: the PLC does not answer the fence.
            PlcRefused: it refuses it.
        """
        if self._state.numbered:
            self._receiver.needs_fence = False  # a late answer shows that the PLC is slow
        elif not self._by_request(before):
            self._by_silence()

    def pass_last(self) -> bool:
        """Send a fence after the last of many requests.

        If the PLC never answered a fence, there is only a note: if nothing unexpected was received before,
        only the proof is missing, not the answers. If something was, silence is used instead.

        Returns:
            True if the answers are proven.

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
        self._note(
            "this PLC does not answer the loopback (4E): late answers to earlier requests cannot be excluded"
        )
        self._passed()
        return False

    def _by_request(self, before: Request[Any] | None) -> bool | None:
        """Send fences until the answer to the last one is received.

        Returns:
            True if it was received, False if it is refused, None if there is no such request.

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
                failure = error  # of an earlier request: an error code does not say which
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
        """Wait until nothing is received for as long as a PLC may take.

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
