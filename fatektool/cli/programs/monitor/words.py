"""In words: why an element is on or off, and how much of the PLC's program is known to be the file's."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.jobs.monitor.same_program import Sameness
from fatektool.jobs.monitor.why import Writing
from fatektool.ladder.circuit.pins import pins_of
from fatektool.ladder.circuit.roles import Role
from fatektool.ladder.power.flow import comparison_sign
from fatektool.ladder.power.values import operand_number, output_contact, signed
from fatektool.program.image import page_ranges
from fatektool.project.comments import comment_of
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fatektool.jobs.monitor.same_program import SameProgram
    from fatektool.jobs.monitor.why import Why, Writer
    from fatektool.ladder.circuit.nodes import Leaf
    from fatektool.ladder.operands import Operand
    from fatektool.ladder.power.causes import Cause, Condition, Way
    from fatektool.ladder.power.logic import State

_WAYS_SHOWN = 8


class WhyWords:
    """The answer in words.

    Args:
        why: the answer.
        comments: of elements.
    """

    def __init__(self, why: Why, comments: Mapping[str, str]) -> None:
        self._why = why
        self._comments = comments
        self._read = why.round.values.get

    def lines(self) -> Iterator[str]:
        """First the answer, then what it is made of, and what may be in its way."""
        yield self.answer()
        why = self._why
        (single,) = why.writers if len(why.writers) == 1 else (None,)
        if single is not None and self._is_plain(single):
            yield from self._ways(single.inputs[0])
            yield f"  {single.network.name}  {_text(single.leaf)}"
        else:
            for writer in why.writers:
                yield from self._writer(writer)
        yield from self.notes()

    def answer(self) -> str:
        """One sentence without its full stop: ``Y4 is off: M421 (Wył. zawór) is off``."""
        why = self._why
        said = self._state_of_element()
        if why.value is None:
            return said
        if why.disabled:
            said += " and disabled: the program does not change it"
        elif not why.writers:
            said += f": {self._unwritten()}"
        elif len(why.writers) > 1:
            said += f": {len(why.writers)} instructions write it"
        elif self._is_plain(why.writers[0]):
            said += self._because(why.writers[0])
        else:
            said += f": {_text(why.writers[0].leaf)} writes it"
        return said

    def notes(self) -> Iterator[str]:
        """What else may be the reason."""
        why = self._why
        if why.round.running is False:
            yield "the PLC is in STOP: its program does not run, and its coils keep what they have"
        if len(why.writers) > 1 and {each.writing for each in why.writers} <= {Writing.OUT, Writing.OUT_NOT}:
            yield "several OUT of one element: the last one in the program decides"
        elif (
            not why.disabled
            and why.round.running is not False
            and any(self._contradicts(writer) for writer in why.writers)
        ):
            yield (
                "its line says otherwise: it was read in another scan, something else writes it, "
                "or the program is another"
            )

    def condition(self, found: Condition) -> str:
        """One instruction on the way: ``M421 (Wył. zawór) is off``."""
        leaf = found.leaf
        if found.function is not None:
            return self._output(found, found.function)
        if leaf.role is Role.LINE:
            return _of_line(found)
        if leaf.role is Role.STEP:
            return f"step {self._bit(leaf.instruction.elements[0])}"
        if leaf.instruction.bit is None:
            return self._comparison(found)
        said = self._bit(leaf.element or leaf.instruction.text)
        if not leaf.edge:
            return said
        when = "comes on" if leaf.edge == "TU" else "goes off"
        return f"{said} ({leaf.edge}: conducts for one scan when it {when})"

    def way(self, way: Way) -> str:
        """The conditions of one way."""
        return " and ".join(map(self.condition, way))

    def name(self, element: str) -> str:
        """An element with its comment."""
        comment = comment_of(element, self._comments)
        return f"{element} ({comment})" if comment else element

    def _is_plain(self, writer: Writer) -> bool:
        """True for an OUT of which it is known what reaches it."""
        return writer.writing is Writing.OUT and len(writer.inputs) == 1

    def _contradicts(self, writer: Writer) -> bool:
        """True if the element is not what this instruction alone would make of it."""
        if len(writer.inputs) != 1 or self._why.value is None:
            return False
        state, value = writer.inputs[0].state, bool(self._why.value)
        match writer.writing:
            case Writing.OUT:
                return state is (not value)
            case Writing.OUT_NOT:
                return state is value
            case Writing.SET | Writing.STEP:
                return state is True and not value and len(self._why.writers) == 1
            case Writing.RESET:
                return state is True and value and len(self._why.writers) == 1
        return False

    def _because(self, writer: Writer) -> str:
        cause = writer.inputs[0]
        value = bool(self._why.value)
        if self._contradicts(writer):
            return f", but its line {'does not carry' if value else 'carries'}{self._reason(cause)}"
        return self._reason(cause)

    def _reason(self, cause: Cause) -> str:
        """Behind a statement: why; of several ways how many there are."""
        if not cause.ways:
            return ": its line has a gap"
        if len(cause.ways) > 1:
            common, _ = _parted(cause)
            none = (
                f"none of {len(cause.ways)} ways conducts"
                if cause.state is False
                else "no way is known to conduct"
            )
            return f": {self.way(common)}, and {none}" if common else f": {none}"
        (way,) = cause.ways
        if not way:
            return ": nothing stands in its way"
        return f": {self.way(way)}"

    def _ways(self, cause: Cause, indent: str = "  ") -> Iterator[str]:
        """Several ways, a line each."""
        if len(cause.ways) < 2:
            return
        _, ways = _parted(cause)
        for number, way in enumerate(ways[:_WAYS_SHOWN], 1):
            yield f"{indent}way {number}: {self.way(way)}"
        if len(cause.ways) > _WAYS_SHOWN:
            yield f"{indent}{len(cause.ways) - _WAYS_SHOWN} more"

    def _writer(self, writer: Writer) -> Iterator[str]:
        head = f"  {writer.network.name}  {_text(writer.leaf)}"
        if writer.reason is not None:
            yield f"{head}: what reaches it is not known: {writer.reason}"
            return
        if not writer.inputs:
            yield head
            return
        pins = pins_of(writer.leaf.instruction.form)
        several = len(writer.inputs) > 1
        for number, cause in enumerate(writer.inputs):
            named = pins.inputs[number] if several and pins and number < len(pins.inputs) else ""
            pin = f"{named or f'input {number + 1}'} " if several else ""
            yield f"{head}: {pin}{_carries(cause.state)}{self._reason(cause)}"
            yield from self._ways(cause, "    ")

    def _state_of_element(self) -> str:
        why = self._why
        if why.value is None:
            return f"{self.name(why.element)} is not known: {why.round.errors.get(why.element, 'not read')}"
        element = Element.parse(why.element)
        if element.kind.bits == 1:
            return f"{self.name(why.element)} is {_on(bool(why.value))}"
        bits = element.kind.bits
        return f"{self.name(why.element)} is {signed(why.value, bits)}"

    def _unwritten(self) -> str:
        if self._why.element.startswith("X"):
            return "an input, which the program does not write"
        if self._why.is_read:
            return "no instruction that is known writes it; a display, another PLC or the PLC itself may"
        return "it is not in the program"

    def _bit(self, element: str) -> str:
        raw = self._read(element)
        return f"{self.name(element)} is {'not known' if raw is None else _on(bool(raw))}"

    def _output(self, found: Condition, function: Leaf) -> str:
        contact = output_contact(function, found.leaf.output)
        if contact is not None:
            return self._bit(contact)
        pins, number = pins_of(function.instruction.form), found.leaf.output
        pin = pins.outputs[number] if pins and number < len(pins.outputs) else f"FO {number}"
        return f"output {pin} of {_text(function)} is not known"

    def _comparison(self, found: Condition) -> str:
        leaf = found.leaf
        a, b = leaf.instruction.operands
        sign = comparison_sign(leaf)
        holds = {True: "holds", False: "does not hold", None: "is not known"}[found.conducts]
        return f"{self._operand(leaf, a)} {sign} {self._operand(leaf, b)} {holds}"

    def _operand(self, leaf: Leaf, operand: Operand) -> str:
        number = operand_number(leaf, operand, self._read)
        if operand.element is None:
            return operand.text
        return f"{self.name(operand.element)} [{'?' if number is None else number}]"


def program_words(found: SameProgram) -> str:
    """How much of the PLC's program is known to be the file's, in one sentence without its full stop."""
    pages = page_ranges(found.pages) if found.pages else ""
    match found.sameness:
        case Sameness.UNKNOWN:
            return f"the PLC's program could not be compared with {found.file.name}: {found.reason}"
        case Sameness.DIFFERENT:
            differ = "differs" if len(found.different) == 1 else "differ"
            return (
                f"the PLC's program is not the one in {found.file.name}: "
                f"{page_ranges(found.different)} of {pages} {differ}; "
                "what is shown is the file's: see 'fatektool verify'"
            )
    whole = "length and checksum of the code are the same" if found.has_sums else "no checksum is known"
    stopped = "" if found.reason is None else f"; {found.reason}"
    same = f"{pages} of the program {'is' if len(found.pages) == 1 else 'are'} the same in PLC and file"
    return f"{same}; {whole}; other pages are not compared{stopped}"


def _text(leaf: Leaf) -> str:
    return leaf.instruction.text.removeprefix("~")


def _on(state: bool) -> str:
    return "on" if state else "off"


def _carries(state: State) -> str:
    return "not known" if state is None else _on(state)


def _of_line(found: Condition) -> str:
    kind = found.leaf.instruction.form.text
    if found.is_in_block:
        return f"what {kind} in a block acts on is not known"
    line = {True: "carries", False: "does not carry", None: "is not known"}[found.carried]
    if kind == "INV":
        return f"the line before INV {line}"
    when = "comes on" if kind == "TU" else "goes off"
    return f"the line before {kind} {line} ({kind}: conducts for one scan when it {when})"


def _parted(cause: Cause) -> tuple[Way, list[Way]]:
    """What all ways need, and what each needs beside that."""
    first, *others = cause.ways
    common = tuple(each for each in first if all(each in way for way in others))
    return common, [tuple(each for each in way if each not in common) for way in cause.ways]
