"""The texts at a sign or in a box, and their width."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.ladder.drawing.signs import Look, frame_of, sign_of
from fatektool.ladder.drawing.text.letters import width_of, wrapped

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fatektool.ladder.circuit.nodes import Leaf
    from fatektool.ladder.drawing.plan import BoxCell
    from fatektool.ladder.drawing.text.pen import Pen
    from fatektool.ladder.drawing.text.states import LiveStates

_COMMENT: Final = 9
_MOST_LINES: Final = 6


@dataclass(frozen=True, slots=True)
class SignText:
    """A sign in characters.

    Attributes:
        look: what it is.
        name: above it.
        sign: itself.
        below: the comments.
        width: the columns that it needs.
    """

    look: Look
    name: str
    sign: str
    below: tuple[str, ...]
    width: int


@dataclass(frozen=True, slots=True)
class BoxText:
    """A box in characters.

    Attributes:
        title: in its upper edge.
        inputs: the name of each input.
        outputs: that of each output.
        settings: its operands, a line each or more.
        before: the columns of the inputs' names.
        width: the columns that it needs, edges included.
    """

    title: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    settings: tuple[str, ...]
    before: int
    width: int


class Writer:
    """Signs and boxes in characters.

    Args:
        pen: what they are written with.
        comments: of elements.
        widest: the columns that one may take.
        states: what is written beside the program; None for nothing.
    """

    def __init__(
        self, pen: Pen, comments: Mapping[str, str], widest: int, states: LiveStates | None = None
    ) -> None:
        self._pen = pen
        self._states = states
        self._comments = comments
        self._widest = widest

    def sign(self, leaf: Leaf) -> SignText:
        """A sign and what is at it."""
        sign = sign_of(leaf)
        pen = self._pen
        inside = {"TU": pen.rising, "TD": pen.falling, "": " "}.get(sign.inside, sign.inside)
        drawn = {
            Look.CONTACT: f"{pen.contact[0]}{inside}{pen.contact[1]}",
            Look.COIL: f"({inside})",
            Look.STEP: f"[{inside}]",
            Look.LINE: inside,
            Look.GAP: " " * 3,
        }[sign.look]
        name, kept = (sign.name, 0) if self._states is None else self._states.name(leaf, sign.name)
        width = max(width_of(drawn) + 4, width_of(name), kept)
        below = wrapped(self._remark(sign.elements), max(width, _COMMENT))[:_MOST_LINES]
        return SignText(sign.look, name, drawn, tuple(below), max([width, *map(width_of, below)]))

    def box(self, box: BoxCell) -> BoxText:
        """A box and what is in it."""
        frame = frame_of(box.leaf)
        inputs = tuple(frame.input_name(pin.number) for pin in box.inputs)
        outputs = tuple(frame.output_name(pin.number) for pin in box.outputs)
        before = max(map(width_of, inputs), default=0)
        after = max(map(width_of, outputs), default=0)
        beside = before + after + 4
        settings = [
            line
            for setting in frame.settings
            for line in self._setting(
                setting.text + (self._states.setting(box.leaf, setting.elements) if self._states else ""),
                self._remark(setting.elements),
                self._widest - beside,
            )
        ]
        if self._states is not None:
            settings += self._states.of_title(box.leaf, frame)
        (title,) = wrapped(self._pen.letters.spell(frame.title), self._widest - 4)[:1]
        width = max([beside + max(map(width_of, settings), default=0), width_of(title) + 4])
        return BoxText(title, inputs, outputs, tuple(settings), before, width)

    def _setting(self, text: str, remark: str, columns: int) -> list[str]:
        """An operand with its comment beside it, or under it."""
        text = self._pen.letters.spell(text)
        if not remark:
            return wrapped(text, columns)
        if width_of(text) + 1 + width_of(remark) <= columns:
            return [f"{text} {remark}"]
        return [*wrapped(text, columns), *(f" {line}" for line in wrapped(remark, columns - 1))]

    def _remark(self, elements: tuple[str, ...]) -> str:
        """The comments of elements; of several, after their names."""
        known = [(element, self._comments[element]) for element in elements if element in self._comments]
        if len(elements) == 1:
            return self._pen.letters.spell(known[0][1]) if known else ""
        return " ".join(f"{element}: {self._pen.letters.spell(comment)}" for element, comment in known)
