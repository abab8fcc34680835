"""What became of values that are being written: as before, uncertain, or acknowledged by the PLC."""

from __future__ import annotations

from contextlib import contextmanager
from enum import Enum
from typing import TYPE_CHECKING

from fatektool.errors import PlcBusy, PlcRefused
from fatektool.planner.atoms import Atom, atoms_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from fatektool.protocol.elements import Element


class Fate(Enum):
    """What is known of a value, the least certain first."""

    UNCERTAIN = "uncertain"
    BEFORE = "before"
    ACKNOWLEDGED = "acknowledged"


class Ledger:
    """Keeps account of each discrete and register for which a write was sent."""

    def __init__(self) -> None:
        self._fates: dict[Atom, Fate] = {}

    @contextmanager
    def entry(self, elements: Iterable[Element]) -> Iterator[None]:
        """One write, which is sent in the ``with`` statement: acknowledged if that ends well.

        It changed nothing if the PLC refused it, or was busy and did not accept it. After any other error it
        may have been made.

        Args:
            elements: what it writes.
        """
        atoms = [atom for element in elements for atom in atoms_of(element)]
        before = {atom: self._fates.get(atom, Fate.BEFORE) for atom in atoms}
        self._fates |= dict.fromkeys(atoms, Fate.UNCERTAIN)
        try:
            yield
        except (PlcRefused, PlcBusy) as error:
            if isinstance(error, PlcRefused) or not error.accepted:
                self._fates |= before
            raise
        self._fates |= dict.fromkeys(atoms, Fate.ACKNOWLEDGED)

    def fate_of(self, element: Element) -> Fate:
        """What is known of an element: the least certain of its parts."""
        fates = {self._fates.get(atom, Fate.BEFORE) for atom in atoms_of(element)}
        return next(fate for fate in Fate if fate in fates)
