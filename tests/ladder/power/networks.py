"""A small interpreter of networks, from the text of their instructions: no circuit, and nothing of ``power``.

It runs one scan of a network, with the states of the elements as they are, and the answer to what they do not
decide (edges, outputs of functions) as given. What each coil and function gets is what it gives back.

What is on the stack is a function: of what comes to its block, what the block hands on. So INV and TD in a
block can be tried both ways: on the block's own signal, or on all that the line carries up to there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from fatektool.ladder.instruction import Instruction


RAIL = True


class Interpreter:
    """A scan of one network.

    Args:
        elements: raw values by name.
        guess: the answer where they do not decide.
        by_line: INV and TD act on all that the line carries.
    """

    def __init__(
        self, elements: Mapping[str, int], guess: Callable[[], bool], *, by_line: bool = False
    ) -> None:
        self._elements = elements
        self._guess = guess
        self._by_line = by_line
        self._stack: list[Callable[[bool], bool]] = []
        self._stores: dict[str, bool] = {}
        self._is_done = False
        self._function = ""
        self.reached: dict[int, tuple[bool, ...]] = {}

    def run(self, instructions: Iterable[Instruction], first: int = 0) -> dict[int, tuple[bool, ...]]:
        """What reaches each coil and function, by its number."""
        for number, instruction in enumerate(instructions, first):
            self._step(number, instruction.text.removeprefix("~").split(" "))
        return self.reached

    def _step(self, number: int, words: list[str]) -> None:  # noqa: PLR0912, C901  # a case an instruction
        match words:
            case [""]:
                pass
            case ["OUT", "TR", store]:
                self._stores[store] = self._stack[-1](RAIL)
            case ["LD", "TR", store]:
                self._begin(self._stores[store])
            case ["FO", output]:
                known = output == "0" and self._function
                self._begin(bool(self._elements[self._function]) if known else self._guess())
            case ["ANDLD"]:
                last = self._stack.pop()
                self._then(lambda block, before: last(block(before)))
            case ["ORLD"]:
                last = self._stack.pop()
                self._then(lambda block, before: block(before) or last(before))
            case ["INV"]:
                self._turn(lambda carried: not carried)
            case ["TU"]:
                rises = self._guess()
                self._then(lambda block, before: block(before) and rises)
            case ["TD"]:
                falls = self._guess()
                self._turn(lambda carried: not carried and falls)
            case [("ORG" | "ORGF" | "LD" | "LDF"), *what]:
                self._begin(self._contact(what))
            case [("AND" | "ANDF"), *what]:
                conducts = self._contact(what)
                self._then(lambda block, before: block(before) and conducts)
                self._is_done = False
            case [("OR" | "ORF"), *what]:
                conducts = self._contact(what)
                self._then(lambda block, before: block(before) or (before and conducts))
            case _:
                self.reached[number] = tuple(block(RAIL) for block in self._stack)
                del self._stack[1:]
                self._is_done = True
                self._function = words[0] if words[0][0] in "TC" and words[0] != "TO" else ""

    def _begin(self, conducts: bool) -> None:
        if self._is_done:
            self._stack.clear()
        self._stack.append(lambda before: before and conducts)
        self._is_done = False

    def _then(self, made: Callable[[Callable[[bool], bool], bool], bool]) -> None:
        block = self._stack.pop()
        self._stack.append(lambda before: made(block, before))

    def _turn(self, turned: Callable[[bool], bool]) -> None:
        """INV or TD: of all that comes, or of what the block has of its own."""
        if self._by_line:
            self._then(lambda block, before: turned(block(before)))
        else:
            self._then(lambda block, before: before and turned(block(RAIL)))

    def _contact(self, what: list[str]) -> bool:  # noqa: PLR0911  # a case each
        match what:
            case ["SHORT"]:
                return True
            case ["OPEN"]:
                return False
            case ["NOT", element]:
                return not self._elements[element]
            case ["TU", element]:
                return bool(self._elements[element]) and self._guess()
            case ["TD", element]:
                return not self._elements[element] and self._guess()
            case [element]:
                return bool(self._elements[element])
        _, sign, first, second = what
        a, b = (self._number(text) for text in (first, second))
        return {">": a > b, "<": a < b, ">=": a >= b, "=<": a <= b, "=": a == b, "<>": a != b}[sign]

    def _number(self, text: str) -> int:
        word = text.partition(":")[2]
        if word[0].isdigit():
            return int(word)
        raw = self._elements[f"R{word}" if word[0] in "TC" else word]
        return raw if raw < 1 << 15 else raw - (1 << 16)
