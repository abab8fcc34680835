"""Requests without an answer whose answers may still come, and how long the late ones took.

A late answer was to be expected, so it is no sign that answers and requests are out of step. It also shows
how long this PLC takes to answer.
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
"""The oldest, whose answers come first, must not be pushed out by the fences that are sent meanwhile."""


class Unanswered(NamedTuple):
    """A request whose answer may still come.

    Attributes:
        sent: the request.
        since: when request and answer could have crossed the line: the PLC's time starts there.
        given_s: how long the answer was to be waited for then.
        waited_for: False if its answer was given up at once.
        before_s: how long the answer took that was taken for its own, if another one comes.
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
    """The requests to one station whose answers may still come, since the last fence.

    Args:
        state: of the link; ``late_s`` is kept up to date.
    """

    def __init__(self, state: LinkState) -> None:
        self._state = state
        self._last: Sent | None = None  # the last request, if its answer is still waited for
        self._last_at = 0.0
        self._last_given_s = 0.0
        self._requests: deque[Unanswered] = deque(maxlen=_MOST)
        self._answered_at = -inf  # when the last one of several outstanding answers came

    @property
    def since(self) -> float | None:
        """Since when the oldest answer is outstanding; None if none is."""
        return self._requests[0].since if self._requests else None

    def note_sent(self, sent: Sent, at: float) -> None:
        """A request was sent.

        Args:
            sent: the request.
            at: when, by the transport's clock.
        """
        self._last = sent
        self._last_at = at
        self._last_given_s = self._state.wait_s

    def forget(self) -> None:
        """No answer can come any more."""
        self._requests.clear()

    def change_station(self) -> None:
        """Another station is asked from now on."""
        self._last = None
        self._requests.clear()

    def keep_last(self, *, waited_for: bool) -> None:
        """The last request found no answer: it may still come.

        Args:
            waited_for: False if it is given up at once.
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
        """An answer was taken. It may be that of an earlier like request; then this one's is outstanding."""
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
            if request.waited_for:  # it came, but late: this PLC gets more time from now on
                self._state.late_s = max(self._state.late_s, self._took_s(request), request.before_s)
        self._answered_at = self._state.transport.clock()
        return request is not None

    def _took_s(self, request: Unanswered) -> float:
        """How long the PLC took for an answer that has just come, in seconds.

        A PLC answers one request after the other, so the time counts from its answer before. If that is less
        than the answer was waited for, something else took the time, and the whole of it counts.
        """
        now = self._state.transport.clock()
        took_s = now - max(request.since, self._answered_at)
        return took_s if took_s > request.given_s else now - request.since
