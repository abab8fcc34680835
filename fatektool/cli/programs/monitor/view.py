"""Which networks are on the screen, and what keys do to that. No terminal, no PLC."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from fatektool.ladder.addresses import spans_of
from fatektool.ladder.cross_reference import CrossReference

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fatektool.jobs.monitor.live import LiveNetwork
    from fatektool.ladder.networks import Code


@dataclass
class View:
    """What is on the screen.

    Args:
        code: the program.
        networks: those that may be moved to.

    Attributes:
        top: the place of the first that is shown.
        skipped: how many of its rows are above the screen.
        shown: how many are shown, as the last frame had it; the last of them may be cut.
        rows_of_top: how many rows the first has, as the last frame had it.
        space: how many rows there were for networks.
        prompt: what is being typed after ``/``; None while nothing is.
        message: an answer to the last key.
        is_over: ``q`` was pressed.
    """

    code: Code
    networks: Sequence[LiveNetwork]
    top: int = 0
    skipped: int = 0
    shown: int = 1
    rows_of_top: int = 0
    space: int = 1
    prompt: str | None = None
    message: str = ""
    is_over: bool = False
    _found: str = ""
    _reference: CrossReference | None = field(default=None, repr=False)

    def press(self, key: str) -> None:
        """Do what a key says."""
        self.message = ""
        if self.prompt is not None:
            self._type(key, self.prompt)
            return
        action = self._actions().get(key)
        if action is not None:
            action()

    def _actions(self) -> dict[str, Callable[[], object]]:
        half, whole = self.space // 2, self.space - 2
        last = len(self.networks) - 1
        return {
            **dict.fromkeys(("q", "Q", ""), self._end),
            **dict.fromkeys(("down", "j"), lambda: self._down(half)),
            **dict.fromkeys(("up", "k"), lambda: self._up(half)),
            **dict.fromkeys(("pgdn", " "), lambda: self._page_down(whole)),
            "pgup": lambda: self._page_up(whole),
            **dict.fromkeys(("home", "g"), lambda: self._go(0)),
            **dict.fromkeys(("end", "G"), lambda: self._go(last)),
            "/": self._ask,
            "n": lambda: self._find(self._found),
        }

    @property
    def visible(self) -> Sequence[LiveNetwork]:
        """Those that are shown."""
        return self.networks[self.top : self.top + self.shown]

    def _go(self, place: int) -> None:
        self.top, self.skipped = min(max(place, 0), len(self.networks) - 1), 0

    def _down(self, rows: int) -> None:
        """To the next network; of one that is taller than the screen, down within it."""
        if self.rows_of_top - self.skipped > self.space:
            self.skipped = min(self.skipped + max(rows, 1), self.rows_of_top - self.space)
        elif self.top + 1 < len(self.networks):
            self._go(self.top + 1)

    def _up(self, rows: int) -> None:
        if self.skipped:
            self.skipped = max(self.skipped - max(rows, 1), 0)
        else:
            self._go(self.top - 1)

    def _end(self) -> None:
        self.is_over = True
        self.message = "ending: waiting for the answer to the last request"

    def _ask(self) -> None:
        self.prompt = ""

    def _page_down(self, rows: int) -> None:
        if self.shown > 1:
            self._go(self.top + self.shown - 1)
        else:
            self._down(rows)

    def _page_up(self, rows: int) -> None:
        if self.skipped:
            self._up(rows)
        else:
            self._go(self.top - max(self.shown - 1, 1))

    def _type(self, key: str, prompt: str) -> None:
        if key == "enter":
            self.prompt = None
            self._find(prompt.strip().upper())
        elif key == "esc" or (key == "backspace" and not prompt):
            self.prompt = None
        elif key == "backspace":
            self.prompt = prompt[:-1]
        elif len(key) == 1 and key.isprintable() and len(prompt) < 10:
            self.prompt = prompt + key
        elif not key:
            self.is_over = True

    def _find(self, element: str) -> None:
        """To the next network after the first one shown that has this element, or what it is part of."""
        if not element:
            return
        self._found = element
        if not spans_of(element):
            self.message = f"no element {element!r} of a program"
            return
        if self._reference is None:
            self._reference = CrossReference(self.code)
        uses = self._reference.uses(element)
        numbers = {place.network for place in (*uses.reads, *uses.writes)}
        places = [place for place, each in enumerate(self.networks) if each.network.number in numbers]
        if not places:
            self.message = f"{element} is in none of the networks"
            return
        place = next((each for each in places if each > self.top), places[0])
        self._go(place)
        more = "; n for the next" if len(places) > 1 else ""
        self.message = f"{element}: {places.index(place) + 1} of {len(places)} networks{more}"
