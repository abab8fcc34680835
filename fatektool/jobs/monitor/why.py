"""Why is an element on or off? All that writes it, and what carries there now, in one round.

It goes one step up: to the contacts on the way, not to what writes these.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

from fatektool.errors import UsageError
from fatektool.jobs.elements.disabled import read_disabled
from fatektool.jobs.monitor.rounds import ElementRounds, Round
from fatektool.ladder.addresses import spans_of
from fatektool.ladder.circuit.nodes import Leaf
from fatektool.ladder.circuit.reading import NoCircuit, circuit_of
from fatektool.ladder.circuit.roles import Role
from fatektool.ladder.cross_reference import CrossReference
from fatektool.ladder.power.causes import Cause, causes_of
from fatektool.ladder.power.values import Shown, shown_of
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fatektool.client import Plc
    from fatektool.ladder.networks import Code, Network


class Writing(StrEnum):
    """How an instruction writes an element."""

    OUT = "out"
    OUT_NOT = "out not"
    SET = "set"
    RESET = "reset"
    STEP = "step"
    FUNCTION = "function"


@dataclass(frozen=True, slots=True)
class Writer:
    """An instruction that writes the element, and what reaches it.

    Attributes:
        network: where it is.
        leaf: it.
        writing: how it writes.
        inputs: what reaches each of its inputs; empty where that is not known.
        reason: why it is not known; None if it is.
    """

    network: Network
    leaf: Leaf
    writing: Writing
    inputs: tuple[Cause, ...]
    reason: str | None = None


@dataclass(frozen=True, slots=True)
class Why:
    """The answer.

    Attributes:
        element: asked for.
        value: raw; None if it could not be read.
        disabled: True if the PLC's program does not change it; None where that is not known.
        writers: what writes it, in the order of the program.
        is_read: the program reads it.
        round: what was read.
    """

    element: str
    value: int | None
    disabled: bool | None
    writers: tuple[Writer, ...]
    is_read: bool
    round: Round


class Question:
    """What has to be known of a program to answer; no PLC is needed yet.

    Args:
        code: the program.
        element: such as ``Y4``.

    Attributes:
        networks: those that write it.

    Raises:
        UsageError: there is no such element in a program.
    """

    def __init__(self, code: Code, element: str) -> None:
        self._element = Element.parse(element)
        self.element = str(self._element)
        if not spans_of(self.element):
            raise UsageError(
                f"no element {element!r} of a program: expected such as Y4, M421, R100, T5", element=element
            )
        uses = CrossReference(code).uses(self.element)
        self._is_read = bool(uses.reads)
        self._places = uses.writes
        numbers = dict.fromkeys(place.network for place in uses.writes)
        self.networks: Sequence[Network] = [code.networks[number] for number in numbers]

    def ask(self, plc: Plc) -> Why:
        """Read what decides it, once.

        Raises:
            LineError: no answer.
        """
        rounds = ElementRounds(plc)
        names = [shown.name for network in self.networks for shown in shown_in(network)]
        rounds.choose([self.element, *names])
        found = rounds.read()
        disabled = None
        if self._element.kind.bits == 1:
            disabled = read_disabled(plc, [self._element])[0].get(self._element)
        by_network = {network.number: network for network in self.networks}
        causes = {number: _causes(network, found) for number, network in by_network.items()}
        writers = tuple(
            self._writer(by_network[place.network], place.instruction, causes[place.network])
            for place in self._places
        )
        value = found.values.get(self.element)
        return Why(self.element, value, disabled, writers, self._is_read, found)

    def _writer(
        self, network: Network, number: int, causes: dict[int, tuple[Cause, ...]] | NoCircuit
    ) -> Writer:
        leaf = Leaf(number, network.instructions[number - network.first])
        writing = _writing(leaf)
        if isinstance(causes, NoCircuit):
            return Writer(network, leaf, writing, (), causes.reason)
        inputs = causes.get(number, ())
        if writing is Writing.OUT:
            inputs = tuple(_without(cause, self.element) for cause in inputs)
        return Writer(network, leaf, writing, inputs)


def shown_in(network: Network) -> list[Shown]:
    """All elements that a network's drawing shows."""
    leaves = (Leaf(number, instruction) for number, _, instruction in network.places)
    return list(dict.fromkeys(shown for leaf in leaves for shown in shown_of(leaf)))


def _causes(network: Network, found: Round) -> dict[int, tuple[Cause, ...]] | NoCircuit:
    circuit = circuit_of(network)
    if isinstance(circuit, NoCircuit):
        return circuit
    return causes_of(circuit, found.values.get).reached


def _writing(leaf: Leaf) -> Writing:
    if leaf.role is not Role.COIL:
        return Writing.FUNCTION
    text = leaf.instruction.form.text
    if text.startswith("OUT "):
        return Writing.OUT_NOT if leaf.is_inverted else Writing.OUT
    if text.startswith("TO "):
        return Writing.STEP
    return Writing.SET if text.startswith(("OUTS", "SET")) else Writing.RESET


def _without(cause: Cause, element: str) -> Cause:
    """A cause without the ways that need the coil's own contact, if there are others: none begins there."""
    if cause.state:
        return cause
    others = tuple(way for way in cause.ways if all(each.leaf.element != element for each in way))
    return Cause(cause.state, others or cause.ways)
