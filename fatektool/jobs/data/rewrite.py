"""The data of a PLC as a part of a write that can be undone.

::

    1. enable      discretes that are not disabled on file       a disabled one does not take a write
    2. write       the values that differ
    3. read        all data, and compare; what differs is written once more
    4. disable     discretes that are disabled on file, then set or reset them
    5. settings    if asked for; last, as a port may change its parameters

A value that does not take is named with its reason, and the rest is written.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import PlcError, PlcRefused
from fatektool.jobs.data.reading import read_values
from fatektool.jobs.elements.disabled import read_disabled
from fatektool.jobs.elements.ledger import Fate, Ledger
from fatektool.jobs.elements.reads import named, read_elements
from fatektool.jobs.elements.spans import spans_of
from fatektool.jobs.elements.writes import send_elements, write_elements
from fatektool.program.data.uses import WRITTEN
from fatektool.protocol.commands import Control, ControlDiscrete
from fatektool.protocol.elements import Element
from fatektool.protocol.values import raw_text

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from fatektool.client import Plc
    from fatektool.jobs.data.plan import DataPlan
    from fatektool.jobs.progress import Progress

_CHUNK: Final = 512
_VALUES: Final = {
    Fate.ACKNOWLEDGED: ("values_written", "written but not read back"),
    Fate.UNCERTAIN: ("values_uncertain", "uncertain"),
    Fate.BEFORE: ("values_old", "the previous value"),
}
_CONTROLS: Final = {
    Fate.ACKNOWLEDGED: ("discretes_written", "enabled or disabled as on file"),
    Fate.UNCERTAIN: ("discretes_uncertain", "not known whether disabled"),
    Fate.BEFORE: ("discretes_old", "enabled or disabled as before"),
}


class DataRewrite:
    """One attempt to put the data of a file into a PLC. It is the part after the program's.

    Args:
        plc: the PLC, in STOP when this is written.
        plan: of this PLC, just now.

    Attributes:
        not_taken: what did not take, in words, by element.
    """

    before: Final = ""
    """The program's part says it of both."""
    mode: Final = ""
    """This too."""

    def __init__(self, plc: Plc, plan: DataPlan) -> None:
        self._plc = plc
        self._plan = plan
        self._before = {change.element: change.before for change in (*plan.values, *plan.settings)}
        self._values = Ledger()
        self._controls = Ledger()
        self._states: dict[Element, int] = {}  # of the discretes to hold, before they were disabled
        self._read_back = False
        self._rolling_back = False
        self._doubtful: set[Element] = set()
        self.not_taken: dict[str, str] = {}

    @property
    def untouched(self) -> bool:
        """True if nothing was written."""
        fates = [self._values.fate_of(element) for element in self._before]
        fates += [self._controls.fate_of(element) for element in self._controlled]
        return all(fate is Fate.BEFORE for fate in fates)

    @property
    def _controlled(self) -> list[Element]:
        return [*self._plan.enable, *self._plan.hold]

    def prepare(self) -> None:
        """The program's part looks at the PLC once more, and stops it."""

    def write(self, progress: Progress) -> None:
        """Write what differs, read all back and compare; ``not_taken`` names what did not take.

        Raises:
            LineError: no answer.
            PlcBusy: the PLC stays busy.
        """
        plan = self._plan
        self._control(Control.ENABLE, plan.enable)
        refused = self._send([(each.element, each.after) for each in plan.values], "writing data", progress)
        self._prove(refused, progress)
        if plan.hold:
            self._states = read_elements(self._plc, list(plan.hold)).values
        self._hold(plan.hold)
        self._prove_disabled({Element.parse(name): on for name, on in plan.wanted.disabled.items()})
        settings = [(each.element, each.after) for each in plan.settings]
        if settings:
            self._note(settings, self._values)

    def _send(
        self, items: Sequence[tuple[Element, int]], phase: str, progress: Progress
    ) -> dict[Element, str]:
        refused: dict[Element, str] = {}
        progress(phase, 0, len(items))
        for first in range(0, len(items), _CHUNK):
            some = items[first : first + _CHUNK]
            refused |= send_elements(self._plc, some, self._values)
            progress(phase, first + len(some), len(items))
        return refused

    def _prove(self, refused: Mapping[Element, str], progress: Progress) -> None:
        """Read all data and compare; write what differs once more."""
        wanted = self._plan.wanted
        found, unread = read_values(
            self._plc, wanted.counts, progress, phase="reading data back", uses=WRITTEN
        )
        for change in self._plan.values:
            if change.element in unread:
                why = unread[change.element]
                self.not_taken[str(change.element)] = f"written, but it cannot be read back: {why}"
        held = {Element.parse(name) for name in wanted.disabled}
        again = []
        for element, value in found.items():
            on_file = wanted.values[element.symbol][element.address]
            if on_file is None or on_file == value or element in held:
                continue
            if element in refused:
                self.not_taken[str(element)] = f"not written: {refused[element]}"
                continue
            present = self._plan.present.values[element.symbol][element.address]
            self._before.setdefault(element, value if present is None else present)
            again.append((element, on_file))
        if again:
            self._note(again, self._values)
        self._read_back = True

    def _note(self, items: Sequence[tuple[Element, int]], ledger: Ledger) -> None:
        """Write elements, read them back, and note what did not take."""
        for each in write_elements(self._plc, items, ledger):
            bits = each.element.kind.bits
            self.not_taken[str(each.element)] = each.words(partial(raw_text, bits=bits))
            self._doubtful.add(each.element)

    # --- disabled discretes ------------------------------------------------------------------------

    def _control(self, control: Control, elements: Iterable[Element]) -> None:
        for element in elements:
            try:
                with self._controls.entry([element]):
                    self._plc.link.ask(ControlDiscrete(control, element))
            except PlcRefused as error:
                self.not_taken[str(element)] = f"{control.name.lower()}: {error.message}"

    def _hold(self, states: Mapping[Element, bool]) -> None:
        """Disable discretes, then set or reset them: an input takes a state only when it is disabled."""
        for element, on in states.items():
            self._control(Control.DISABLE, [element])
            self._control(Control.SET if on else Control.RESET, [element])

    def _prove_disabled(self, wanted: Mapping[Element, bool]) -> None:
        """Read back what was enabled, disabled, set and reset."""
        if not self._controlled:
            return
        flags, _ = read_disabled(self._plc, self._controlled)
        held = [element for element in self._controlled if element in wanted]
        states = read_elements(self._plc, held).values if held else {}
        for element in self._controlled:
            name, disabled = str(element), flags.get(element)
            if name in self.not_taken:
                continue
            if disabled is not (element in wanted):
                self.not_taken[name] = f"not {'disabled' if element in wanted else 'enabled'}"
            elif element in wanted and bool(states.get(element)) is not wanted[element]:
                self.not_taken[name] = f"disabled, but not {'on' if wanted[element] else 'off'}"

    # --- the way back ------------------------------------------------------------------------------

    def put_back(self, progress: Progress) -> None:
        """Write back all that may not be as before, settings first, and read it back.

        Raises:
            PlcError: something does not take its previous value.
            LineError: no answer.
        """
        plan, undone = self._plan, Ledger()
        self._rolling_back = True
        now = {Element.parse(name): on for name, on in plan.present.disabled.items()}
        touched = [each for each in self._controlled if self._controls.fate_of(each) is not Fate.BEFORE]
        values = [
            (element, before)
            for element, before in self._before.items()
            if self._values.fate_of(element) is not Fate.BEFORE
        ]
        progress("rolling back data", 0, len(values))
        self.not_taken.clear()
        settings = {change.element for change in plan.settings}
        self._note([each for each in values if each[0] in settings], undone)
        self._control(Control.ENABLE, [each for each in touched if each not in now])
        self._note([each for each in values if each[0] not in settings and each[0] not in now], undone)
        states = [(each, on) for each, on in self._states.items() if each in touched and each not in now]
        self._note([each for each in states if each[0].symbol != "X"], undone)  # X follows its terminal
        self._hold({each: now[each] for each in touched if each in now})
        self._prove_disabled(now)
        progress("rolling back data", len(values), len(values))
        if self.not_taken:
            name, why = next(iter(self.not_taken.items()))
            raise PlcError(f"{named(self.not_taken)} did not take what was there before: {name}: {why}")

    def look(self) -> None:
        """Nothing is asked: a value that is uncertain is written again."""

    def states(self) -> list[tuple[str, str]]:
        """What the PLC holds of each value and each disabled discrete, in ranges."""
        found = []
        for fate, (_, holds) in _VALUES.items():
            new = fate is Fate.ACKNOWLEDGED and self._read_back
            if spans := self._spans(self._before, fate):
                found.append((named(spans), "the new value" if new else holds))
        for fate, (_, holds) in _CONTROLS.items():
            if spans := self._spans(self._controlled, fate):
                found.append((named(spans), holds))
        return found

    def details(self) -> dict[str, Any]:
        """The same for scripts."""
        values = {key: self._spans(self._before, fate) for fate, (key, _) in _VALUES.items()}
        return values | {key: self._spans(self._controlled, fate) for fate, (key, _) in _CONTROLS.items()}

    def _spans(self, elements: Iterable[Element], fate: Fate) -> list[str]:
        controls = elements is not self._before
        return spans_of(each for each in elements if self._fate_of(each, controls=controls) is fate)

    def _fate_of(self, element: Element, *, controls: bool) -> Fate:
        fate = (self._controls if controls else self._values).fate_of(element)
        unsure = self._rolling_back or (element in self._doubtful and not controls)
        return Fate.UNCERTAIN if unsure and fate is not Fate.BEFORE else fate
