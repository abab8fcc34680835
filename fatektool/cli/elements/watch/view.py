"""Which elements are on the screen, and what keys do to that. No terminal, no PLC."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from fatektool.errors import UsageError
from fatektool.jobs.elements.assignment import parse_assignments

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.jobs.elements.selection import Item

_KEYS = "q end   space pause   w write   arrows PgUp PgDn move"
_LONGEST = 200


@dataclass
class WatchView:
    """What is on the screen.

    Args:
        count: how many elements there are.
        name: of the PLC, for a question.
        write: has values written.
        refusal: why nothing may be written; empty if it may.

    Attributes:
        top: the place of the first that is shown.
        space: how many are shown.
        is_paused: no rounds are wanted.
        prompt: what is being typed after ``w``; None while nothing is.
        message: an answer to the last key.
        is_over: ``q`` was pressed.
    """

    count: int
    name: str
    write: Callable[[str, list[tuple[Item, int]]], object]
    refusal: str = ""
    top: int = 0
    space: int = 1
    is_paused: bool = False
    prompt: str | None = None
    message: str = ""
    is_over: bool = False
    _asked: str = ""
    _pairs: list[tuple[Item, int]] = field(default_factory=list)

    @property
    def foot(self) -> str:
        """The last line."""
        if self._asked:
            return f"Write {self._asked} into {self.name}? [y/N]"
        if self.prompt is not None:
            return f"write, such as R12=5: {self.prompt}_"
        below = self.count - self.top - self.space
        more = f"and {below} more   " if below > 0 else ""
        return self.message or f"{more}{_KEYS}"

    def fit(self, space: int) -> range:
        """The places that are shown on ``space`` lines."""
        self.space = max(space, 1)
        self.top = min(self.top, max(self.count - self.space, 0))
        return range(self.top, min(self.top + self.space, self.count))

    def press(self, key: str) -> None:
        """Do what a key says."""
        self.message = ""
        if not key:
            self.is_over = True
        elif self._asked:
            self._answer(key)
        elif self.prompt is not None:
            self._type(key, self.prompt)
        else:
            action = self._actions().get(key)
            if action is not None:
                action()

    def _actions(self) -> dict[str, Callable[[], object]]:
        return {
            **dict.fromkeys(("q", "Q"), self._end),
            **dict.fromkeys(("down", "j"), lambda: self._move(1)),
            **dict.fromkeys(("up", "k"), lambda: self._move(-1)),
            "pgdn": lambda: self._move(self.space),
            "pgup": lambda: self._move(-self.space),
            **dict.fromkeys(("home", "g"), lambda: self._move(-self.count)),
            **dict.fromkeys(("end", "G"), lambda: self._move(self.count)),
            " ": self._pause,
            "w": self._ask,
        }

    def _move(self, by: int) -> None:
        self.top = max(min(self.top + by, self.count - self.space), 0)

    def _end(self) -> None:
        self.is_over = True
        self.message = "ending: waiting for the answer to the last request"

    def _pause(self) -> None:
        self.is_paused = not self.is_paused

    def _ask(self) -> None:
        if self.refusal:
            self.message = self.refusal
        else:
            self.prompt = ""

    def _type(self, key: str, prompt: str) -> None:
        if key == "enter":
            self.prompt = None
            self._question(prompt.strip())
        elif key == "esc" or (key == "backspace" and not prompt):
            self.prompt = None
        elif key == "backspace":
            self.prompt = prompt[:-1]
        elif len(key) == 1 and key.isprintable() and len(prompt) < _LONGEST:
            self.prompt = prompt + key

    def _question(self, text: str) -> None:
        if not text:
            return
        try:
            self._pairs = parse_assignments(text.split())
        except UsageError as error:
            self.message = error.message
        else:
            self._asked = text

    def _answer(self, key: str) -> None:
        text, self._asked = self._asked, ""
        if key in {"y", "Y"}:
            self.message = f"writing {text}"
            self.write(text, self._pairs)
        else:
            self.message = "nothing was written"
