"""Many requests of one kind, none of which gets another's answer: reads, and writes, which need no more.

An answer that came twice could pass for the next question's, and shift all that follow by one. So answers are
taken as proven only behind a fence:

- Input that nobody asked for has shown up: what was read since the last fence is read again, each behind a
  fence of its own, as the first answer behind a fence is the right one.
- Something else went wrong (a time-out, noise, a foreign frame): it may have been the stray answer, come to
  grief, and a shift would have lasted up to it. So few answers are enough to tell: the one in whose exchange
  it was, the one before, and the last that differs from the one behind it. These are read again.
- At the end comes a fence, with the same test if it does not come down cleanly.

On a clean line all this costs one fence, and nothing where answers bear the number of their request. What it
cannot see is an answer that came twice and another one lost right behind it, which leaves no trace: a second
pass is what finds that.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Generic, TypeVar

from fatektool.errors import PlcRefused
from fatektool.exchange.stream import ask_in_stream

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fatektool.exchange.link import Link
    from fatektool.protocol.commands import Request

A = TypeVar("A")
B = TypeVar("B")


def ask_all(
    link: Link, requests: Sequence[Request[A]], on_answer: Callable[[int], None] | None = None
) -> list[A]:
    """Send reads one after the other and give their answers in order.

    Args:
        link: the line.
        requests: reads.
        on_answer: is called with the number of answers so far.

    Raises:
        NoAnswer: one of them found no answer to trust.
        PlcRefused: one of them was refused.
    """
    answers, refusal = ask_until_refused(link, requests, on_answer)
    if refusal is not None:
        raise refusal
    return answers


def ask_until_refused(
    link: Link, requests: Sequence[Request[A]], on_answer: Callable[[int], None] | None = None
) -> tuple[list[A], PlcRefused | None]:
    """Send reads one after the other, up to the first that is refused; give the proven answers before it.

    Args:
        link: the line.
        requests: reads.
        on_answer: is called with the number of answers so far.

    Returns:
        The answers in order, and what the PLC said to the request behind them; None if none was refused.

    Raises:
        NoAnswer: one of them found no answer to trust.
    """
    batch = _Batch(link, requests, on_answer)
    refusal: PlcRefused | None = None
    try:
        while len(batch.answers) < len(requests):
            if len(batch.answers) + 1 < len(requests):
                ask_in_stream(link, requests, len(batch.answers), batch.take)
            if len(batch.answers) < len(requests):
                batch.ask()
    except PlcRefused as error:
        refusal = error
    if batch.answers and len(requests) > 1:
        try:
            batch.close()
        except PlcRefused as error:  # what was answered before is refused now: nothing is proven
            return [], error
    return batch.answers, refusal


def proven(link: Link, work: Callable[[], B], again: Callable[[], B]) -> B:
    """Do work that asks one thing after the other, each by what was answered before.

    Args:
        link: the line.
        work: asks, and gives what it found.
        again: the same, each of its reads behind a fence (``Link.fence``) of its own. It is done if something
            was out of order on the line, as an answer may then have been another question's.

    Raises:
        NoAnswer: there was no answer to trust.
        PlcRefused: the PLC refuses a fence that it took before.
    """
    signs = link.signs[:2]
    found = work()
    link.fences.close()
    return found if link.signs[:2] == signs else again()


def tell_all(
    link: Link, requests: Sequence[Request[None]], on_answer: Callable[[int], None] | None = None
) -> None:
    """Send writes one after the other, each when the one before it is acknowledged.

    An acknowledgement may be another's, as everywhere; what was written must be read back.

    Args:
        link: the line.
        requests: writes.
        on_answer: is called with the number of acknowledged writes so far.

    Raises:
        LineError: the one behind those found no answer to trust; it may have been made.
        PlcRefused: that one was refused.
        LineReadOnly: the line may only be read.
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
            if not (lost and link.took(requests[done])):
                link.ask(requests[done])
            take(None)


class _Batch(Generic[A]):
    def __init__(
        self, link: Link, requests: Sequence[Request[A]], on_answer: Callable[[int], None] | None
    ) -> None:
        self._link = link
        self._requests = requests
        self._on_answer = on_answer
        self._unproven: list[int] = []  # read since the last fence
        self._signs = link.signs
        self.answers: list[A] = []

    def take(self, answer: A) -> None:
        """An answer that came while all was in order."""
        self._unproven.append(len(self.answers))
        self.answers.append(answer)
        if self._on_answer is not None:
            self._on_answer(len(self.answers))

    def ask(self) -> None:
        """Ask the next one with all care."""
        place = len(self.answers)
        self.take(self._link.ask(self._requests[place]))
        if self._link.signs != self._signs:
            self._unproven.pop()
            self._look_into_it(place)
            self._signs = self._link.signs

    def _look_into_it(self, place: int) -> None:
        """Something was out of order before or in the exchange of this place."""
        suspicions, _, fences = self._signs
        if self._link.suspicions == suspicions:
            fenced = self._link.counters.fences != fences
            self._check_unproven([] if fenced else [place])
        self._unproven.append(place)
        if self._link.suspicions != suspicions:
            self._ask_unproven_again()

    def close(self) -> None:
        """Prove what is not proven yet."""
        link = self._link
        suspicions, trouble, _ = self._signs
        proven = link.fences.close()
        if link.suspicions != suspicions:
            self._ask_unproven_again()
        elif proven and link.signs[1] != trouble:
            self._check_unproven([])

    def _check_unproven(self, doubtful: list[int]) -> None:
        """Read again what tells of a shift.

        Args:
            doubtful: the answer in whose exchange the trouble was, unless a fence stood before it.
        """
        suspicions = self._link.suspicions
        places = self._unproven
        telling = [*doubtful, *places[-1:]]
        for place, behind in zip(reversed(places[:-1]), reversed(places[1:]), strict=True):
            if self.answers[place] != self.answers[behind]:
                telling.append(place)
                break
        held = all(self._ask_behind_fence(place) == self.answers[place] for place in telling)
        if not held or self._link.suspicions != suspicions:
            self._unproven = places + doubtful
            self._ask_unproven_again()
        self._unproven = []

    def _ask_unproven_again(self) -> None:
        for place in self._unproven:
            self.answers[place] = self._ask_behind_fence(place)
        self._unproven = []

    def _ask_behind_fence(self, place: int) -> A:
        self._link.fence(self._requests[place])
        return self._link.ask(self._requests[place])
