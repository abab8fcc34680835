"""Many requests of one kind, reads or writes, so that none gets the answer to another.

An answer that is received twice could be taken for that of the next request, and shift all that follow by
one. So answers count as proven only after a fence:

- After unsolicited input, everything that was read since the last fence is read again, each request after a
  fence of its own, because the first answer after a fence is the right one.
- Another error (a time-out, noise, a frame of another station) may have been the extra answer, damaged, and
  the answers before it may be shifted. A few of them show it: the one in whose exchange the error was, the
  one before, and the last that differs from the one after it. These are read again.
- At the end a fence is sent, with the same check if anything unexpected is received before its answer.

On a clean line this costs one fence, and nothing if answers carry the number of their request. One case is
not detected, because nothing shows it: an answer received twice, with the next one lost. A second pass of
reads finds that.
"""

from __future__ import annotations

from bisect import bisect_left
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from fatektool.errors import PlcRefused
from fatektool.exchange.stream import ask_in_stream, no_more

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Sequence

    from fatektool.exchange.link import Link
    from fatektool.protocol.commands import Request

A = TypeVar("A")
B = TypeVar("B")


def read_all(
    link: Link, requests: Sequence[Request[A]], on_answer: Callable[[int], None] | None = None
) -> list[A]:
    """Send reads one after the other and return their answers in order.

    Args:
        link: the link.
        requests: reads.
        on_answer: gets the number of answers so far.

    Raises:
        NoAnswer: no valid answer to one of them.
        PlcRefused: one of them was refused.
    """
    answers, refusal = read_until_refused(link, requests, on_answer)
    if refusal is not None:
        raise refusal
    return answers


def read_separated(
    link: Link,
    requests: Sequence[Request[A]],
    separator: Request[Any],
    places: Collection[int],
    on_answer: Callable[[int], None] | None = None,
) -> list[A]:
    """Send reads as ``read_all`` does, and another read before some of them.

    Args:
        link: the link.
        requests: reads.
        separator: the other read, so that an answer before it cannot be taken for one after it.
        places: places in ``requests`` before which it is sent.
        on_answer: gets the number of answers to ``requests`` so far.

    Raises:
        NoAnswer: no valid answer to one of them.
        PlcRefused: one of them was refused.
    """
    if not places:
        return read_all(link, requests, on_answer)
    sent: list[Request[Any]] = []
    kept: list[int] = []
    for place, request in enumerate(requests):
        if place in places:
            sent.append(separator)
        kept.append(len(sent))
        sent.append(request)

    def count(done: int) -> None:
        if on_answer is not None:
            on_answer(bisect_left(kept, done))

    answers = read_all(link, sent, count)
    return [answers[place] for place in kept]


def read_until_refused(
    link: Link,
    requests: Sequence[Request[A]],
    on_answer: Callable[[int], None] | None = None,
    more: Callable[[], bool] = no_more,
) -> tuple[list[A], PlcRefused | None]:
    """Send reads one after the other, up to the first that is refused; return the proven answers before it.

    Args:
        link: the link.
        requests: reads.
        on_answer: gets the number of answers so far.
        more: adds a read to ``requests``; returns False if there is none. It is called while the line is
            busy, for a plan that is made meanwhile.

    Returns:
        The answers in order, and the refusal of the request after them; None if none was refused.

    Raises:
        NoAnswer: no valid answer to one of them.
    """
    batch = _Batch(link, requests, on_answer)
    refusal: PlcRefused | None = None
    try:
        while len(batch.answers) < len(requests) or more():
            if len(batch.answers) + 1 < len(requests) or more():
                take = batch.answers.append if on_answer is None else batch.take
                ask_in_stream(link, requests, len(batch.answers), take, more)
            if len(batch.answers) < len(requests):
                batch.ask()
    except PlcRefused as error:
        refusal = error
    if batch.answers and len(requests) > 1:
        try:
            batch.prove_last()
        except PlcRefused as error:  # a request that was answered before is refused now: nothing is proven
            return [], error
    return batch.answers, refusal


def proven(link: Link, work: Callable[[], B], again: Callable[[], B]) -> B:
    """Do work in which each request depends on the answers before it.

    Args:
        link: the link.
        work: sends requests and returns what it found.
        again: the same, each of its reads after a fence (``Link.fence``) of its own. It is called if
            something unexpected was received, because an answer may then have been that of another request.

    Raises:
        NoAnswer: no valid answer.
        PlcRefused: the PLC refuses a fence that it answered before.
    """
    before = link.disturbances[:2]
    found = work()
    link.fences.pass_last()
    return found if link.disturbances[:2] == before else again()


def write_all(
    link: Link, requests: Sequence[Request[None]], on_answer: Callable[[int], None] | None = None
) -> None:
    """Send writes one after the other, each when the one before it is acknowledged.

    An acknowledgement may be that of another write: what was written must be read back.

    Args:
        link: the link.
        requests: writes.
        on_answer: gets the number of acknowledged writes so far.

    Raises:
        LineError: no valid answer to the write after those; it may have been made.
        PlcRefused: that write was refused.
        LineReadOnly: the line is read-only.
    """
    done = 0

    def take(_: None) -> None:
        nonlocal done
        done += 1
        if on_answer is not None:
            on_answer(done)

    while done < len(requests):
        lost = ask_in_stream(link, requests, done, take)
        if done < len(requests):
            if not (lost and link.is_made(requests[done])):
                link.ask(requests[done])
            take(None)


class _Batch(Generic[A]):
    """Answers in order of their requests; those before ``_proven`` are proven by a fence."""

    def __init__(
        self, link: Link, requests: Sequence[Request[A]], on_answer: Callable[[int], None] | None
    ) -> None:
        self._link = link
        self._requests = requests
        self._on_answer = on_answer
        self._proven = 0
        self._disturbances = link.disturbances  # when the last answer was accepted
        self.answers: list[A] = []

    def take(self, answer: A) -> None:
        """Keep an answer that was received while nothing unexpected was."""
        self.answers.append(answer)
        if self._on_answer is not None:
            self._on_answer(len(self.answers))

    def ask(self) -> None:
        """Send the next request alone, with retries, and check whether anything unexpected was received."""
        place = len(self.answers)
        self.take(self._link.ask(self._requests[place]))
        if self._link.disturbances != self._disturbances:
            unsolicited, _, fences = self._disturbances
            if self._link.unsolicited == unsolicited:
                fenced = self._link.counters.fences != fences
                self._check(place, suspects=[] if fenced else [place])
            if self._link.unsolicited != unsolicited:
                self._read_again(place + 1)
            self._disturbances = self._link.disturbances

    def prove_last(self) -> None:
        """Prove the answers that are not proven yet."""
        link = self._link
        unsolicited, trouble, _ = self._disturbances
        passed = link.fences.pass_last()
        if link.unsolicited != unsolicited:
            self._read_again(len(self.answers))
        elif passed and link.disturbances[1] != trouble:
            self._check(len(self.answers), suspects=[])

    def _check(self, end: int, suspects: list[int]) -> None:
        """Prove the answers before a place: read those again that would show a shift.

        Args:
            end: the place.
            suspects: the answer in whose exchange the error was, unless a fence was sent before it.
        """
        unsolicited = self._link.unsolicited
        places = range(self._proven, end)
        telling = [*suspects, *places[-1:]]
        for place in reversed(places[:-1]):
            if self.answers[place] != self.answers[place + 1]:
                telling.append(place)
                break
        held = all(self._ask_after_fence(place) == self.answers[place] for place in telling)
        if not held or self._link.unsolicited != unsolicited:
            self._read_again(end + len(suspects))
        self._proven = end

    def _read_again(self, end: int) -> None:
        """Read the unproven answers before a place again, each after a fence."""
        for place in range(self._proven, end):
            self.answers[place] = self._ask_after_fence(place)
        self._proven = end

    def _ask_after_fence(self, place: int) -> A:
        self._link.fence(self._requests[place])
        return self._link.ask(self._requests[place])
