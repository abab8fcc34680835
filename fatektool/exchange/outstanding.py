"""Requests without an answer whose answers may still be received, and how long the late ones took.

A late answer is expected, so it does not mean that answers are shifted. It also shows how long this PLC takes
to answer.
"""

from __future__ import annotations

from collections import deque
from math import inf
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from fatektool.exchange.sent import Sent
    from fatektool.exchange.state import LinkState
    from fatektool.protocol.codec import Frame

_MOST: Final = 64
"""The fences that are sent meanwhile must not push out the oldest, whose answers come first."""


class Unanswered(NamedTuple):
    """A request whose answer may still be received.

    Attributes:
        sent: the request.
        since: when request and answer could have passed the line: the start of the PLC's time.
        given_s: seconds for the answer from then on.
        waited_for: False if its answer was not waited for.
        before_s: seconds that the accepted answer took, in case another one is received.
    """

    sent: Sent
    since: float
    given_s: float
    waited_for: bool
    before_s: float = 0.0

    def is_answered_by(self, frame: Frame) -> bool:
        """True if the frame may be its answer."""
        return self.sent.answered_by(frame) and self.sent.data in {None, frame.data}


class Outstanding:
    """The requests to one station since the last fence whose answers may still be received.

    Args:
        state: of the link; ``late_s`` is kept up to date.
    """

    def __init__(self, state: LinkState) -> None:
        self._state = state
        self._last: Sent | None = None  # the last request, if its answer is still waited for
        self._last_at = 0.0
        self._last_given_s = 0.0
        self._requests: deque[Unanswered] = deque(maxlen=_MOST)
        self._answered_at = -inf  # when the last one of several outstanding answers was received

    @property
    def since(self) -> float | None:
        """The time since which the oldest answer is outstanding; None if none is."""
        return self._requests[0].since if self._requests else None

    def note_sent(self, sent: Sent, at: float) -> None:
        """Note that a request was sent.

        Args:
            sent: the request.
            at: when, by the transport's clock.
        """
        self._last = sent
        self._last_at = at
        self._last_given_s = self._state.wait_s

    def forget(self) -> None:
        """Note that no answer can be received any more."""
        self._requests.clear()

    def change_station(self) -> None:
        """Note that requests go to another station from now on."""
        self._last = None
        self._requests.clear()

    def keep_last(self, *, waited_for: bool) -> None:
        """Note that the last request has no answer, and that it may still be received.

        Args:
            waited_for: False if it is not waited for.
        """
        if self._last is not None:
            sent = self._last._replace(raw=b"")
            self._requests.append(Unanswered(sent, self._last_since, self._last_given_s, waited_for))
            self._last = None

    @property
    def _last_since(self) -> float:
        sent = self._last
        wire_bytes = len(sent.raw) + sent.size if sent is not None else 0
        return self._last_at + wire_bytes * self._state.byte_time_s

    def note_answer(self, frame: Frame) -> None:
        """Note an accepted answer; if it was that of an earlier equal request, this one's is outstanding."""
        for place, request in enumerate(self._requests):
            if request.is_answered_by(frame):
                self._answered_at = now = self._state.transport.clock()
                before_s = now - request.since
                self._requests[place] = request._replace(since=self._last_since, before_s=before_s)
                break
        self._last = None

    def take_late(self, frame: Frame) -> bool:
        """True if a frame of this station, which answers nothing asked now, is one of these answers."""
        request = next((request for request in self._requests if request.is_answered_by(frame)), None)
        if request is not None:
            self._requests.remove(request)
            if request.waited_for:  # late: this PLC gets more time from now on
                self._state.late_s = max(self._state.late_s, self._took_s(request), request.before_s)
        self._answered_at = self._state.transport.clock()
        return request is not None

    def _took_s(self, request: Unanswered) -> float:
        """How long the PLC took for an answer that was just received, in seconds.

        A PLC answers one request after the other, so the time counts from its previous answer. If that is
        no more than the time given for the answer, something else took the time, and all of it counts.
        """
        now = self._state.transport.clock()
        took_s = now - max(request.since, self._answered_at)
        return took_s if took_s > request.given_s else now - request.since
