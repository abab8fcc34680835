"""A modem that does what its script says, with a PLC at the other end of the telephone line.

It has no thread and no clock: bytes and times in, bytes and times out, so that it stands behind a line in
memory as well as behind a pty. It speaks by V.250 alone; no word of it comes from the client's code.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fatektool.simulator.listen.base import ServedLine

Pieces = list[tuple[float, bytes]]

FIGURES = {
    "OK": 0,
    "CONNECT": 1,
    "RING": 2,
    "NO CARRIER": 3,
    "ERROR": 4,
    "NO DIALTONE": 6,
    "BUSY": 7,
    "NO ANSWER": 8,
}
SILENCE = ""
"""A call with this outcome goes on until it is given up."""


@dataclass
class ScriptedModem:
    """A modem and its telephone line.

    Args:
        calls: what becomes of each call: a result in words, or ``SILENCE``; the last stands for all after it.
        plc: what answers during a call; None for a line on which nobody speaks.
        answers: of commands, instead of OK, by the command as it was typed; a result, or raw bytes.
        dead: True if it is switched off.
        echo: True if it gives back commands until it is told E0; ``stubborn`` keeps it so.
        figures: True if it answers in figures until it is told V1; ``stubborn`` keeps it so.
        stubborn: True for a modem that keeps its echo and figures.
        dtr: True for a port with that wire, at whose fall it hangs up (&D2).
        talk_s: time that it takes to answer a command.
        ring_s: time that a call takes to its outcome.
        carrier_bytes: how many bytes the PLC may say before the telephone line breaks.

    Attributes:
        commands: what it was told, in order.
        online: True during a call.
        hung_up: how often a call was ended by the computer's end.
        aborted: how often a call was given up before its outcome.
        guard_broken: True if ``+++`` came without silence around it.
    """

    calls: list[str] = field(default_factory=lambda: ["CONNECT 9600"])
    plc: ServedLine | None = None
    answers: dict[str, str | bytes] = field(default_factory=dict)
    dead: bool = False
    echo: bool = True
    figures: bool = False
    stubborn: bool = False
    dtr: bool = False
    talk_s: float = 0.001
    ring_s: float = 0.001
    carrier_bytes: int | None = None
    powered: bool = True
    commands: list[str] = field(default_factory=list)
    online: bool = False
    escaped: bool = False
    hung_up: int = 0
    aborted: int = 0
    guard_broken: bool = False
    guard_s: float = 1.0
    dialling_until: float | None = None
    _outcome: str = ""
    _typed: str = ""
    _last_heard: float = -1e9
    _plus_at: float | None = None

    # --- as the simulator's doors want it -------------------------------------------------------------

    def line(self, *, whole_answers: bool = False) -> ServedLine:
        assert not whole_answers, "a modem hangs on a stream"
        return self

    def datagram(self, data: bytes, now: float) -> Pieces:
        return self.receive(data, now)

    # --- the wire ---------------------------------------------------------------------------------------

    def receive(self, data: bytes, now: float) -> Pieces:
        if self.dead:
            return []
        quiet_s, self._last_heard = now - self._last_heard, now
        self.settle(now)
        if self._plus_at is not None and now - self._plus_at < self.guard_s:
            self.guard_broken = True
        self._plus_at = None
        if self.dialling_until is not None:
            self.dialling_until = None
            self.aborted += 1
            return self._say("NO CARRIER", now)
        if self.online and not self.escaped:
            if data == b"+++" and quiet_s >= self.guard_s:
                self._plus_at, self.escaped = now, True
                return self._say("OK", now + self.guard_s)
            return self._carry(data, now)
        pieces: Pieces = [(now, data)] if self.echo else []
        for character in data.decode("ascii"):
            if character == "\r":
                pieces += self._command(self._typed.strip(), now)
                self._typed = ""
            else:
                self._typed += character
        return pieces

    def lose_dtr(self, now: float) -> Pieces:
        self.settle(now)
        self.dialling_until = None
        if not self.online:
            return []
        self._end_call()
        return self._say("NO CARRIER", now)

    def _carry(self, data: bytes, now: float) -> Pieces:
        answer = self.plc.receive(data, now) if self.plc is not None else []
        if self.carrier_bytes is None:
            return answer
        kept: Pieces = []
        for due, piece in answer:
            kept.append((due, piece[: self.carrier_bytes]))
            self.carrier_bytes -= len(kept[-1][1])
        if self.carrier_bytes:
            return kept
        self.online = False
        return [*kept, (kept[-1][0] if kept else now, b"\r\nNO CARRIER\r\n")]

    # --- commands ---------------------------------------------------------------------------------------

    def _command(self, typed: str, now: float) -> Pieces:
        start = typed.upper().find("AT")
        if start < 0:
            return []
        command = typed[start:].upper()
        self.commands.append(typed[start:])
        if not self.stubborn:
            self.echo = self.echo and "E0" not in command
            self.figures = self.figures and "V1" not in command
        answer = self.answers.get(command)
        if isinstance(answer, bytes):
            return [(now + self.talk_s, answer)]
        if answer is not None:
            return self._say(answer, now)
        if re.fullmatch("ATD[TP].+", command):
            return self._dial(now)
        guard = re.search(r"S12=(\d+)", command)
        if guard:
            self.guard_s = int(guard[1]) / 50
        if command == "ATH" and self.online:
            self._end_call()
        return self._say("OK", now)

    def _dial(self, now: float) -> Pieces:
        self._outcome = self.calls.pop(0) if len(self.calls) > 1 else self.calls[0]
        if self._outcome == SILENCE:
            self.dialling_until = 1e9
            return []
        self.dialling_until = now + self.ring_s
        said = self._said("RING") + self._said(self._outcome)
        return [(self.dialling_until, said)]

    def settle(self, now: float) -> None:
        """Let a call that is due be taken."""
        if self.dialling_until is not None and now >= self.dialling_until:
            self.dialling_until = None
            self.online = self._outcome.startswith("CONNECT")
            self.escaped = False

    def _end_call(self) -> None:
        self.online = self.escaped = False
        self.hung_up += 1

    def _say(self, words: str, now: float) -> Pieces:
        return [(now + self.talk_s, self._said(words))]

    def _said(self, words: str) -> bytes:
        if not self.figures:
            return f"\r\n{words}\r\n".encode()
        return f"{FIGURES['CONNECT' if words.startswith('CONNECT') else words]}\r".encode()
