"""What a loopback test's figures show, for the rules of the diagnosis."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.errors import FrameError
from fatektool.jobs.linetest.binomial import at_least

if TYPE_CHECKING:
    from fatektool.jobs.linetest.finding import Case
    from fatektool.jobs.linetest.loopback.result import LoopbackResult, Tally

_CHANCE: Final = 0.001
"""What comes by chance once in a thousand tests is no evidence."""


def grows(by_size: dict[int, Tally]) -> bool:
    """True if the larger frames fail more often than chance lets them, were size of no account.

    The sizes are parted where the test is most telling; the chance is made smaller by the number of ways to
    part them (Bonferroni).
    """
    sizes = sorted(by_size)
    for cut in range(1, len(sizes)):
        small = [by_size[size] for size in sizes[:cut]]
        large = [by_size[size] for size in sizes[cut:]]
        few, of_few = sum(map(damaged, small)), sum(tally.sent for tally in small)
        many, of_many = sum(map(damaged, large)), sum(tally.sent for tally in large)
        if many * of_few <= 2 * few * of_many:
            continue
        rate = (few + 1) / (of_few + 1)  # of the small ones, on the careful side
        if rate < 1 and at_least(many, of_many, rate) * (len(sizes) - 1) < _CHANCE:
            return True
    return False


def damaged(tally: Tally) -> int:
    """How many exchanges brought something that was no good frame."""
    return tally.errors["checksum"] + tally.errors["garbled"]


def answers_heard(result: LoopbackResult) -> int:
    """Frames of which a good part was readable: the line's settings are right."""
    errors = result.total.errors
    return errors["mismatch"] + errors["stale"] + errors["refused"] + errors["checksum"]


def framed_with_parity(case: Case) -> bool:
    """True if the received bytes are a frame without their eighth bits: those were parity."""
    noise = case.result.heard.noise
    if not any(byte & 0x80 for byte in noise):
        return False
    decoder = case.codec.decoder()
    decoder.feed(bytes(byte & 0x7F for byte in noise))
    while True:
        try:
            return decoder.next_frame() is not None
        except FrameError:
            continue


def sample(result: LoopbackResult) -> str:
    """The first received bytes that are no frame, in hex."""
    return result.heard.noise[:12].hex(" ").upper() + (" …" if result.heard.noise_bytes > 12 else "")
