"""Which discretes are disabled (43)."""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING, Final

from fatektool.errors import PlcRefused
from fatektool.exchange.batch import proven, read_all, read_until_refused
from fatektool.jobs.elements.division import Division, Refusals
from fatektool.protocol.commands import MAX_DISCRETES, Command, ReadDisabled
from fatektool.protocol.elements import Stretch

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from fatektool.client import Plc
    from fatektool.protocol.elements import Element

_BY_PLACE: Final = attrgetter("symbol", "address")


def read_disabled(plc: Plc, elements: Iterable[Element]) -> tuple[dict[Element, bool], Refusals]:
    """Which discretes are disabled, and why that is not known of the others.

    Nothing is known if the protocol has no command for it.

    Args:
        plc: the PLC.
        elements: discretes of one bit.

    Raises:
        LineError: no answer.
    """
    if Command.READ_DISABLED not in plc.link.codec.commands:
        return {}, Refusals()
    wanted = sorted(set(elements), key=_BY_PLACE)
    return proven(plc.link, lambda: _read(plc, wanted, fenced=False), lambda: _read(plc, wanted, fenced=True))


def _read(plc: Plc, wanted: list[Element], *, fenced: bool) -> tuple[dict[Element, bool], Refusals]:
    flags: dict[Element, bool] = {}
    refusals = Refusals()

    def together(some: Sequence[Element]) -> list[Element]:
        requests = [ReadDisabled(run[0], len(run)) for run in _runs(some)]
        while requests:
            if fenced:
                plc.link.fence(requests[0])
            answers, refusal = read_until_refused(plc.link, requests[:1] if fenced else requests)
            for request, bits in zip(requests, answers, strict=False):
                flags.update(zip(Stretch(request.first, len(bits)), bits, strict=True))
            requests = requests[len(answers) + (refusal is not None) :]
        return [element for element in some if element not in flags]

    def alone(element: Element) -> str | None:
        request = ReadDisabled(element, 1)
        if fenced:
            plc.link.fence(request)
        try:
            ((flags[element],),) = read_all(plc.link, [request])
        except PlcRefused as error:
            return error.message
        return None

    division = Division(wanted, together, alone, refusals)
    for run in _runs(together(wanted)):
        division.divide(run)
    return flags, refusals


def _runs(elements: Iterable[Element]) -> Iterator[list[Element]]:
    """Neighbours together, as many as one request asks for."""
    run: list[Element] = []
    for element in elements:
        if run and (_BY_PLACE(element) != (run[-1].symbol, run[-1].address + 1) or len(run) == MAX_DISCRETES):
            yield run
            run = []
        run.append(element)
    if run:
        yield run
