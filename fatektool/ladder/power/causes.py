"""Why a signal is on or off: the contacts that it comes through, or those that are open on each way to it.

A way is what has to conduct for the signal to be on. Of a signal that is off each way has a contact that is
open; the contacts of a way that conduct are left out. A way that needs all that another needs, and more, is
left out, too. Only the easiest ways are kept where there are very many.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.ladder.power.flow import Power
from fatektool.ladder.power.walk import Signals, Walk

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from typing import TypeAlias

    from fatektool.ladder.circuit.nodes import Circuit, Leaf
    from fatektool.ladder.power.logic import State
    from fatektool.ladder.power.values import Reader

MOST_WAYS: Final = 64


@dataclass(frozen=True, slots=True)
class Condition:
    """An instruction on the way.

    Attributes:
        leaf: it.
        conducts: whether it does.
        function: of an output the function.
        carried: of TU, TD and INV: whether the line before it carries.
        is_in_block: of TD and INV: it is in a block, and what it acts on is not known.
    """

    leaf: Leaf
    conducts: State
    function: Leaf | None = None
    carried: State = None
    is_in_block: bool = False


Way: TypeAlias = tuple[Condition, ...]


@dataclass(frozen=True, slots=True)
class Cause:
    """A signal.

    Attributes:
        state: on, off, or not known.
        ways: of one that is on a way that conducts; else what is open, or not known, on each way. Empty where
            there is no way at all, as in a line with a gap.
    """

    state: State
    ways: tuple[Way, ...]


class Causes(Signals[Cause]):
    """A signal is whether there is power, and why.

    Args:
        read: the raw value of an element by its name.
    """

    rail = Cause(state=True, ways=((),))

    def __init__(self, read: Reader) -> None:
        self._power = Power(read)

    def contact(self, leaf: Leaf) -> Cause:
        """A contact by itself."""
        if leaf.is_wire:
            return self.rail
        if leaf.is_gap:
            return Cause(state=False, ways=())
        return _single(Condition(leaf, self._power.contact(leaf)))

    def output(self, leaf: Leaf, function: Leaf) -> Cause:
        """An output of a function by itself."""
        return _single(Condition(leaf, self._power.output(leaf, function), function))

    def of_line(self, leaf: Leaf, carried: Cause) -> Cause:
        """An edge of a line that is off for certain is off as the line is; all else begins anew here."""
        state = self._power.of_line(leaf, carried.state)
        if leaf.instruction.form.text == "TU" and carried.state is False:
            return carried
        return _single(Condition(leaf, state, carried=carried.state))

    def unsure(self, leaf: Leaf) -> Cause:
        """Not known, because of it."""
        return _single(Condition(leaf, None, is_in_block=True))

    def state(self, signal: Cause) -> State:
        """Whether it is on."""
        return signal.state

    def both(self, one: Cause, other: Cause) -> Cause:
        """Two in series."""
        if one.state and other.state:
            return Cause(state=True, ways=(one.ways[0] + other.ways[0],))
        if one.state or other.state:
            return other if one.state else one
        ways = _fewest(first + second for first in one.ways for second in other.ways)
        return Cause(self._power.both(one.state, other.state), ways)

    def either(self, signals: Sequence[Cause]) -> Cause:
        """Several in parallel."""
        state = self._power.either([each.state for each in signals])
        if state:
            ways = [each.ways[0] for each in signals if each.state]
            return Cause(state=True, ways=(min(ways, key=len),))
        return Cause(state, _fewest(way for each in signals for way in each.ways))


def causes_of(circuit: Circuit, read: Reader) -> Walk[Cause]:
    """What carries in a circuit, and why.

    Args:
        circuit: it.
        read: the raw value of an element by its name; None where it is not known.
    """
    return Walk(circuit, Causes(read))


def _single(condition: Condition) -> Cause:
    return Cause(condition.conducts, ((condition,),))


def _fewest(ways: Iterable[Way]) -> tuple[Way, ...]:
    """The ways of which none needs all that another needs, those with the fewest conditions first."""
    kept: list[tuple[frozenset[object], Way]] = []
    for way in sorted(map(_once, ways), key=len):
        needs = frozenset(map(_key, way))
        if not any(other <= needs for other, _ in kept):
            kept.append((needs, way))
    return tuple(way for _, way in kept[:MOST_WAYS])


def _once(way: Way) -> Way:
    """Each condition once, wherever it stands."""
    return tuple({_key(condition): condition for condition in reversed(way)}.values())[::-1]


def _key(condition: Condition) -> object:
    """Two contacts of one element that conduct together are one condition."""
    leaf = condition.leaf
    if leaf.element is None:
        return leaf.number
    return leaf.element, leaf.is_inverted, leaf.edge
