"""What stands on the screen: a head, the networks as far as they fit, and a foot. No terminal, no PLC."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.files.times import local_clock
from fatektool.ladder.circuit.nodes import Leaf
from fatektool.ladder.circuit.reading import NoCircuit
from fatektool.ladder.drawing.text.draw import NARROWEST
from fatektool.ladder.drawing.text.letters import pieces, width_of, wrapped
from fatektool.ladder.drawing.text.live import LivePen, Row, Strip, live_rows
from fatektool.ladder.drawing.text.states import LiveStates, value_text
from fatektool.ladder.power.values import shown_of
from fatektool.project.comments import text_in

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fatektool.cli.programs.monitor.view import View
    from fatektool.jobs.monitor.live import LiveNetwork
    from fatektool.jobs.monitor.rounds import Round
    from fatektool.project.comments import Comments

WIDEST: Final = 200
_NOTE_LINES: Final = 3
_KEYS: Final = "arrows PgUp PgDn: move   / find   q end"


@dataclass(frozen=True, slots=True)
class News:
    """What is known now.

    Attributes:
        round: the last round; None if there is none, or if the line is lost since.
        rate: rounds a second; 0 if it is not known yet.
        lost: what is wrong with the line, and since when; empty if nothing is.
        program: what is to be known of the PLC's program; empty if nothing is.
    """

    round: Round | None
    rate: float = 0.0
    lost: str = ""
    program: str = ""


class Frames:
    """Makes what stands on the screen.

    Args:
        name: of the file.
        place: of the PLC, in words.
        comments: the program's.
        pen: what the networks are drawn with.
    """

    def __init__(self, name: str, place: str, comments: Comments, pen: LivePen) -> None:
        self._name = name
        self._place = place
        self._comments = comments
        self._pen = pen

    def frame(self, view: View, news: News, columns: int, lines: int) -> list[Row]:
        """All rows of a screen of this size; notes in ``view`` what of the networks is on it."""
        width = min(max(columns, 1), WIDEST)
        notes = self._notes(view, news, width)
        view.space = max(lines - 2 - len(notes), 1)
        body = self._body(view, news, width)
        head = self._head(view, news)
        foot = f"/{view.prompt}_" if view.prompt is not None else view.message or _KEYS
        rows = [_plain(head, width), *(_plain(note, width, is_lit=True) for note in notes), *body]
        rows += [()] * (lines - 1 - len(rows))
        return [*rows[: lines - 1], _plain(self._pen.letters.spell(foot), width)]

    def rows(self, networks: Sequence[LiveNetwork], news: News, columns: int) -> Iterator[Row]:
        """Networks one below the other, as far as they go: for a terminal without a cursor."""
        for network in networks:
            yield from self._network(network, news, min(columns, WIDEST))
            yield ()

    def _head(self, view: View, news: News) -> str:
        first, last = view.visible[0].network, view.visible[-1].network
        shown = first.name if first is last else f"{first.name}-{last.name}"
        of = view.networks[-1].network.name
        parts = [f"{shown} of {of}"]
        if news.round is not None:
            mode = {True: "RUN", False: "STOP", None: "mode unknown"}[news.round.running]
            parts += [mode, f"{news.rate:.1f} rounds/s", local_clock(news.round.time)]
        return self._pen.letters.spell("  ".join([*parts, self._name, self._place]))

    def _notes(self, view: View, news: News, width: int) -> list[str]:
        """What is wrong, in a few lines each."""
        notes = [news.lost, news.program]
        if news.round is not None:
            shown = {each.name for network in view.visible for each in network.shown}
            refused = [(name, why) for name, why in news.round.errors.items() if name in shown]
            if refused:
                (name, why), more = refused[0], len(refused) - 1
                notes.append(f"{name}: {why}" + (f"; {more} more without a value" if more else ""))
        spelt = [self._pen.letters.spell(note) for note in notes if note]
        return [line for note in spelt for line in wrapped(note, max(width, 2))[:_NOTE_LINES]]

    def _body(self, view: View, news: News, width: int) -> list[Row]:
        """The networks from the first one on, as far as they fit; the first and last may be cut."""
        rows: list[Row] = []
        count = 0
        for network in view.networks[view.top :]:
            if len(rows) >= view.space:
                break
            drawn = [*self._network(network, news, width)]
            if not count:
                view.rows_of_top = len(drawn)
                view.skipped = min(view.skipped, max(len(drawn) - view.space, 0))
                drawn = drawn[view.skipped :]
            rows += [*drawn, ()]
            count += 1
        view.shown = max(count, 1)
        return rows[: view.space]

    def _network(self, each: LiveNetwork, news: News, width: int) -> Iterator[Row]:
        network = each.network
        spell = self._pen.letters.spell
        text = text_in(network.addresses, self._comments.networks) or ""
        yield _plain(spell(f"{network.name}  {text}".rstrip()), width)
        values = {} if news.round is None else news.round.values
        if isinstance(each.circuit, NoCircuit):
            yield _plain(spell(f"not drawn: {each.circuit.reason}"), width)
            for number, _, instruction in network.places:
                shown = shown_of(Leaf(number, instruction))
                known = (
                    f"{one.name}={value_text(values[one.name], one) if one.name in values else '?'}"
                    for one in shown
                )
                line = f"  {number:04}  {instruction.text:<24}  {'  '.join(known)}".rstrip()
                yield _plain(spell(line), width)
            return
        states = LiveStates(each.circuit, values.get)
        yield from live_rows(each.circuit, self._comments.elements, max(width, NARROWEST), self._pen, states)


def _plain(text: str, width: int, *, is_lit: bool = False) -> Row:
    """A text that is no drawing, cut to a width."""
    if width_of(text) > width:
        kept, used = "", 0
        for piece, columns in pieces(text):
            if used + columns > width - 1:
                break
            kept, used = kept + piece, used + columns
        text = f"{kept}>"
    return (Strip(text, is_lit),)
