"""Networks beside what a PLC has, round after round: which are read may change between two rounds."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from fatektool.jobs.monitor.rounds import ElementRounds, Round
from fatektool.jobs.monitor.same_program import SameProgram
from fatektool.jobs.monitor.why import shown_in
from fatektool.ladder.circuit.reading import NoCircuit, circuit_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fatektool.client import Plc
    from fatektool.ladder.circuit.nodes import Circuit
    from fatektool.ladder.networks import Network
    from fatektool.ladder.power.values import Shown
    from fatektool.project.program_file import ProgramFile


@dataclass(frozen=True)
class LiveNetwork:
    """A network, with its circuit and elements found once.

    Attributes:
        network: it.
    """

    network: Network

    @cached_property
    def circuit(self) -> Circuit | NoCircuit:
        """Its circuit, or why it has none."""
        return circuit_of(self.network)

    @cached_property
    def shown(self) -> tuple[Shown, ...]:
        """The elements that are read for it."""
        return tuple(shown_in(self.network))


class Monitor:
    """Reads the elements of networks, and compares the PLC's program with the file's on the way.

    Before the first round the header's pages and those of the chosen networks are compared; of networks that
    are chosen later one page a round, so that no round takes long.

    Args:
        plc: the PLC.
        file: the program on file.
        networks: those to read.
        pages_of: the networks whose pages are compared; None for those that are read.

    Attributes:
        networks: those to read; may be set by another thread, and holds from the next round on.
        program: the comparison so far.
    """

    def __init__(
        self,
        plc: Plc,
        file: ProgramFile,
        networks: Sequence[LiveNetwork],
        pages_of: Sequence[LiveNetwork] | None = None,
    ) -> None:
        self.networks = networks
        self.program = SameProgram(plc, file)
        self._pages_of = pages_of
        self._rounds = ElementRounds(plc)
        self._has_begun = False

    def read(self) -> Round:
        """One round.

        Raises:
            LineError: no answer.
        """
        networks = self.networks
        compared = networks if self._pages_of is None else self._pages_of
        missing = self.program.missing(each.network for each in compared)
        self.program.compare(missing[:1] if self._has_begun else missing)
        self._has_begun = True
        self._rounds.choose(shown.name for network in networks for shown in network.shown)
        return self._rounds.read()
