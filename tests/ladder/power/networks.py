"""A small interpreter of networks, from the text of their instructions: no circuit, and nothing of ``power``.

It runs one scan of a network, with the states of the elements as they are, and the answer to what they do not
decide (edges, outputs of functions) as given. What each coil and function gets is what it gives back.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from fatektool.ladder.instruction import Instruction


class Interpreter:
    """A scan of one network.

    Args:
        elements: raw values by name.
        guess: the answer where they do not decide.
    """

    def __init__(self, elements: Mapping[str, int], guess: Callable[[], bool]) -> None:
        self._elements = elements
        self._guess = guess
        self._stack: list[bool] = []
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
                self._stores[store] = self._stack[-1]
            case ["LD", "TR", store]:
                self._begin(self._stores[store])
            case ["FO", output]:
                known = output == "0" and self._function
                self._begin(bool(self._elements[self._function]) if known else self._guess())
            case ["ANDLD"]:
                last = self._stack.pop()
                self._stack[-1] = self._stack[-1] and last
            case ["ORLD"]:
                last = self._stack.pop()
                self._stack[-1] = self._stack[-1] or last
            case ["INV"]:
                self._stack[-1] = not self._stack[-1]
            case ["TU"]:
                self._stack[-1] = self._stack[-1] and self._guess()
            case ["TD"]:
                self._stack[-1] = not self._stack[-1] and self._guess()
            case [("ORG" | "ORGF" | "LD" | "LDF"), *what]:
                self._begin(self._contact(what))
            case [("AND" | "ANDF"), *what]:
                conducts = self._contact(what)
                self._stack[-1] = self._stack[-1] and conducts
                self._is_done = False
            case [("OR" | "ORF"), *what]:
                conducts = self._contact(what)
                self._stack[-1] = self._stack[-1] or conducts
            case _:
                self.reached[number] = tuple(self._stack)
                del self._stack[1:]
                self._is_done = True
                self._function = words[0] if words[0][0] in "TC" and words[0] != "TO" else ""

    def _begin(self, conducts: bool) -> None:
        if self._is_done:
            self._stack.clear()
        self._stack.append(conducts)
        self._is_done = False

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
