"""Many requests of one kind, none of which gets another's answer.

An answer that came twice could pass for the next question's, and shift all that follow by one. It shows
sooner or later: as input that nobody asked for, at the latest before the fence at the end. Then what was read
since the last fence is read again, each behind a fence of its own: the first answer behind a fence is the
right one. On a clean line all this costs one loopback.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

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
    answers: list[A] = []
    unproven: list[int] = []  # read since the last fence
    for place, request in enumerate(requests):
        suspicions, fences = link.suspicions, link.counters.fences
        answers.append(link.ask(request))
        if link.suspicions != suspicions:
            _ask_again(link, requests, answers, [*unproven, place])
            unproven = []
        elif link.counters.fences != fences:  # nothing astray came before it: the earlier ones hold
            unproven = [place]
        else:
            unproven.append(place)
        if on_answer is not None:
            on_answer(place + 1)
    suspicions = link.suspicions
    link.closing_fence()
    if link.suspicions != suspicions:
        _ask_again(link, requests, answers, unproven)
    return answers


def _ask_again(link: Link, requests: Sequence[Request[A]], answers: list[A], places: Iterable[int]) -> None:
    for place in places:
        link.fence()
        answers[place] = link.ask(requests[place])
