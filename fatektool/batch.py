"""Many requests of one kind, none of which gets another's answer.

An answer that came twice could pass for the next question's, and shift all that follow by one. So answers are
taken as proven only behind a fence:

- Input that nobody asked for has shown up: what was read since the last fence is read again, each behind a
  fence of its own, as the first answer behind a fence is the right one.
- A fence was put up for another reason (a time-out, noise): a shift, had there been one, would have lasted up
  to it. So one answer is enough to tell, the last that differs from the one before it; it is read again.
- At the end comes a fence, with the same test if the line was not clean.

On a clean line all this costs one loopback. What it cannot see is an answer that came twice and another one
lost right behind it, which leaves no trace: a second pass is what finds that.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Generic, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fatektool.link import Link
    from fatektool.protocol.commands import Request

A = TypeVar("A")


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
    batch = _Batch(link, requests)
    for place in range(len(requests)):
        batch.ask(place)
        if on_answer is not None:
            on_answer(place + 1)
    batch.close()
    return batch.answers


class _Batch(Generic[A]):
    def __init__(self, link: Link, requests: Sequence[Request[A]]) -> None:
        self._link = link
        self._requests = requests
        self._unproven: list[int] = []  # read since the last fence
        self.answers: list[A] = []

    def ask(self, place: int) -> None:
        link = self._link
        suspicions, fences = link.suspicions, link.counters.fences
        self.answers.append(link.ask(self._requests[place]))
        self._unproven.append(place)
        if link.suspicions != suspicions:
            self._ask_unproven_again()
        elif link.counters.fences != fences:
            self._unproven.pop()
            if not self._last_hold():
                self._ask_unproven_again()
            self._unproven = [place]

    def close(self) -> None:
        link = self._link
        suspicions = link.suspicions
        link.closing_fence()
        if link.suspicions != suspicions or (link.counters.trouble and not self._last_hold()):
            self._ask_unproven_again()

    def _ask_unproven_again(self) -> None:
        for place in self._unproven:
            self.answers[place] = self._ask_behind_fence(place)
        self._unproven = []

    def _ask_behind_fence(self, place: int) -> A:
        self._link.fence()
        return self._link.ask(self._requests[place])

    def _last_hold(self) -> bool:
        """Read again the last answer and, if it is like those before it, the last that is not."""
        if not self._unproven:
            return True
        last = self._unproven[-1]
        change = last
        while change > self._unproven[0] and self.answers[change] == self.answers[change - 1]:
            change -= 1
        return all(self._ask_behind_fence(place) == self.answers[place] for place in {last, change})
