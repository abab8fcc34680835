"""A PLC on a telephone line: a serial port with a modem that calls and hangs up.

::

    IDLE ──ATDT──> CALLING ──CONNECT──> ONLINE ──NO CARRIER──> LOST
     ^                │                   │                     │
     └── any byte ────┘    ┌── DTR off, or +++ and ATH ─────────┘
     └──────────────── close

``close`` always hangs up: an open call costs money and blocks the PLC for others. If the process is killed,
the system switches off DTR, with which most modems hang up (&D2). If a modem did not, +++ ends that call
before the next one.

The paper: FBs-PLC communication link, chapter 13, the modem at port 1.
"""

from __future__ import annotations

import contextlib
from enum import Enum, auto
from math import ceil
from typing import TYPE_CHECKING, Final

from fatektool.callbacks import ignore
from fatektool.counts import counted
from fatektool.errors import LineError, TransportClosed, TransportError
from fatektool.transport.base import Transport
from fatektool.transport.modem.commands import ModemCommands, Result

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.transport.modem.dial import Call

_SETUP: Final = "ATE0Q0V1"
"""No echo, results on, results as text."""

_ANSWER_S: Final = 1.0
_SLOW_ANSWER_S: Final = 5.0
_SETTLE_S: Final = 0.2
"""Text about the connection after CONNECT is received within this time."""

_FIFTIETHS: Final = 50
_CALL_ENDED: Final = b"\r\nNO CARRIER\r\n"
_MAY_HELP: Final = {Result.BUSY, Result.NO_CARRIER, Result.NO_ANSWER, None}
"""After these results another call may succeed."""

_ADVICE: Final = {
    Result.BUSY: "the telephone line is in use: call later",
    Result.NO_CARRIER: "no modem answered the call, or the modems found no common speed: check the number, "
    "and that the PLC's modem is on",
    Result.NO_ANSWER: "the call is not answered: check that the PLC and its modem are on, and that it "
    "answers calls (R4149 high byte 55H, R4163 high byte: rings)",
    Result.NO_DIALTONE: "check that the telephone line is plugged in. If the exchange gives no dial tone, "
    "add init=ATX3",
    Result.ERROR: "the modem does not accept the number: try dial=pulse, or another init",
    Result.OK: "the modem accepted the command, but did not call: check init",
    Result.VOICE: "a person answered the call: check the number",
    Result.BARRED: "the modem does not call this number again so soon: wait, or switch it off and on",
    None: "no result: check that the number is complete. A slow exchange needs a longer wait=…",
}


class _State(Enum):
    IDLE = auto()
    CALLING = auto()
    ONLINE = auto()
    LOST = auto()
    CLOSED = auto()


class ModemTransport(Transport):
    """The port of a modem; ``connect`` calls, ``close`` hangs up.

    It has no ``serial_settings``: those of the port are between computer and modem, and those of the PLC
    cannot be set from here.

    Args:
        port: the open serial port; closed with this.
        call: the number to call, and how.
        note: gets each command and result of the modem, for ``-v``.
    """

    def __init__(self, port: Transport, call: Call, note: Callable[[str], None] = ignore) -> None:
        self.name = f"modem:{port.name} to {call.number}"
        self.clock = port.clock
        self._port = port
        self._call = call
        self._note = note
        self._modem = ModemCommands(port, call.guard_s, note)
        self._state = _State.IDLE
        self._heard = b""

    # --- the call -----------------------------------------------------------------------------------

    def connect(self) -> None:
        """Find the modem, set it up and call, with retries.

        Raises:
            LineError: no connection; the message has the modem's results.
        """
        self._wake()
        for command in (*self._call.init, _SETUP):
            self._require(command)
        guard = max(1, int(self._call.guard_s * _FIFTIETHS))
        for command in (f"ATS7={ceil(self._call.wait_s)}", f"ATS2=43S12={guard}"):
            if self._modem.ask(command, _ANSWER_S) is not Result.OK:
                self._note(f"{self._port.name}: the modem does not accept {command}")
        outcomes: list[Result | None] = []
        while len(outcomes) < self._call.tries:
            if outcomes:
                self._modem.rest(self._call.pause_s)
            outcome = self._dial()
            if outcome is Result.CONNECT:
                self._modem.rest(_SETTLE_S)
                return
            outcomes.append(outcome)
            if outcome not in _MAY_HELP:
                break
        raise self._no_connection(outcomes)

    def _wake(self) -> None:
        """Find the modem in its command state, or bring it into that state."""
        for _ in range(2):  # it may detect the speed from the first
            if self._modem.ask(_SETUP, _ANSWER_S) is not None:
                return
        heard = self._modem.heard
        self._modem.escape(_ANSWER_S)  # a call of a process that was killed
        self._modem.ask("ATH", _ANSWER_S)
        if self._modem.ask(_SETUP, _ANSWER_S) is not None:
            return
        got = f"received {heard.hex(' ').upper()}, which is not a result" if heard else "nothing received"
        raise LineError(
            f"{self._port.name}: no modem answers {_SETUP} at {self._port.serial_settings}: {got}",
            hint="check that the modem is on, and its cable. Most modems need --line 8N1",
            result=None,
        )

    def _require(self, command: str) -> None:
        result = self._modem.ask(command, _SLOW_ANSWER_S)
        if result is not Result.OK:
            got = result.value if result else "nothing"
            raise LineError(
                f"{self._port.name}: {command} to the modem: expected OK, got {got}",
                hint="check init= with the manual of the modem",
                result=result.value if result else None,
            )

    def _dial(self) -> Result | None:
        self._state = _State.CALLING
        result = self._modem.ask(self._call.command, self._call.wait_s)
        if result is None and self._modem.ask("", _SLOW_ANSWER_S) is Result.CONNECT:
            result = Result.CONNECT  # received just after the wait
        self._state = _State.ONLINE if result is Result.CONNECT else _State.IDLE
        return result

    def _no_connection(self, outcomes: list[Result | None]) -> LineError:
        got = [outcome.value if outcome else f"nothing for {self._call.wait_s:g} s" for outcome in outcomes]
        count = counted(len(outcomes), "try", "tries")
        return LineError(
            f"{self._port.name}: no connection to {self._call.number} in {count}: the modem reported "
            f"{', '.join(got)}",
            hint=_ADVICE[outcomes[-1]],
            result=outcomes[-1].value if outcomes[-1] else None,
            tries=len(outcomes),
        )

    # --- bytes --------------------------------------------------------------------------------------

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Read what is received first; bytes before the end of a call are returned before its error."""
        self._require_online()
        data = self._until_the_end(self._port.read(max_bytes, timeout_s))
        if not data:
            raise self._ended()
        return data

    def write(self, data: bytes) -> None:
        """Write all of ``data``."""
        self._require_online()
        self._port.write(data)

    def drain(self) -> bytes:
        """Return what was received already."""
        return self._until_the_end(self._port.drain()) if self._state is _State.ONLINE else b""

    def _until_the_end(self, data: bytes) -> bytes:
        """The bytes before the modem's message that the call has ended, which may be received in pieces."""
        before = len(self._heard)
        heard = self._heard + data
        place = heard.find(_CALL_ENDED)
        self._heard = heard[1 - len(_CALL_ENDED) :]
        if place < 0:
            return data
        self._state = _State.LOST
        return heard[before : max(before, place)]

    def _require_online(self) -> None:
        if self._state is _State.LOST:
            raise self._ended()
        if self._state is not _State.ONLINE:
            raise TransportClosed(f"{self.name}: not connected")

    def _ended(self) -> TransportClosed:
        return TransportClosed(
            f"{self.name}: the call ended (NO CARRIER)",
            hint="a bad telephone line, or the other modem hung up: run again after ten seconds",
        )

    # --- the end ------------------------------------------------------------------------------------

    def close(self) -> None:
        """Hang up in any state of the call, and close the port."""
        state, self._state = self._state, _State.CLOSED
        try:
            if state in {_State.CALLING, _State.ONLINE, _State.LOST}:
                with contextlib.suppress(TransportError):  # the port is lost, and DTR with it
                    self._hang_up(state)
        finally:
            self._port.close()

    def _hang_up(self, state: _State) -> None:
        modem = self._modem
        if state is _State.CALLING:  # any character stops the dialling (V.250)
            modem.ask("", _ANSWER_S)
        if self._port.set_dtr(on=False):
            if modem.result(_ANSWER_S) is not None:
                return
            self._port.set_dtr(on=True)  # many modems accept no command without it
        if state is not _State.ONLINE and modem.ask("ATH", _ANSWER_S) is Result.OK:
            return
        modem.escape(_ANSWER_S)
        if modem.ask("ATH", _SLOW_ANSWER_S) not in {Result.OK, Result.NO_CARRIER}:
            self._note(f"{self._port.name}: the modem does not confirm that it hung up")
