"""The fourteen commands as values: one frozen dataclass for each, checked against its limits when made.

A request has what is asked, but not its format: a codec (``facon``) converts it into bytes, and the answer's
bytes into the type in brackets, ``Request[tuple[int, ...]]``. The answer to a command that is only
acknowledged is ``None``.

::

    40 ReadBriefStatus   41 RunStop           42 ControlDiscrete   43 ReadDisabled
    44 ReadDiscretes     45 WriteDiscretes    46 ReadRegisters     47 WriteRegisters
    48 ReadMixed         49 WriteMixed        4E Loopback          4F ReadPage
    50 WritePage         53 ReadDetailedStatus

Limits: FACON paper, section 4.2. The M-series paper, section 2.5, has the same numbers of elements: 256
discretes, 64 registers, 64 and 32 mixed words. FACON counts a 32-bit element as two words, in a run and in a
mixed request; the M-series paper only has "1 to 64 words" in its list of commands. The rule is used for both.
The length of a run depends on the protocol: the codec checks it.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, ClassVar, Final, Generic, TypeVar

from fatektool.errors import UsageError
from fatektool.value import Value, frozen

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fatektool.protocol.elements import Element
    from fatektool.protocol.status import BriefStatus, DetailedStatus, RawStatus  # noqa: F401  # in strings

A = TypeVar("A")

PAGE_WORDS: Final = 64
PAGE_BYTES: Final = 2 * PAGE_WORDS
BRIEF_BYTES: Final = 3
DETAILED_BYTES: Final = 64
MAX_DISCRETES: Final = 256
MAX_READ_WORDS: Final = 64
MAX_MIXED_WRITE_WORDS: Final = 32
MAX_LOOPBACK: Final = 256
_ONE_WORD: Final = 0xFFFF


class Command(IntEnum):
    """Command codes, the same in FACON and M-series frames."""

    BRIEF_STATUS = 0x40
    RUN_STOP = 0x41
    CONTROL_DISCRETE = 0x42
    READ_DISABLED = 0x43
    READ_DISCRETES = 0x44
    WRITE_DISCRETES = 0x45
    READ_REGISTERS = 0x46
    WRITE_REGISTERS = 0x47
    READ_MIXED = 0x48
    WRITE_MIXED = 0x49
    LOOPBACK = 0x4E
    READ_PAGE = 0x4F
    WRITE_PAGE = 0x50
    DETAILED_STATUS = 0x53

    @property
    def words(self) -> str:
        """The command as text."""
        return COMMAND_WORDS[self]


COMMAND_WORDS: Final = {
    Command.BRIEF_STATUS: "read brief status",
    Command.RUN_STOP: "run or stop",
    Command.CONTROL_DISCRETE: "control one discrete",
    Command.READ_DISABLED: "read enable status",
    Command.READ_DISCRETES: "read discretes",
    Command.WRITE_DISCRETES: "write discretes",
    Command.READ_REGISTERS: "read registers",
    Command.WRITE_REGISTERS: "write registers",
    Command.READ_MIXED: "read mixed elements",
    Command.WRITE_MIXED: "write mixed elements",
    Command.LOOPBACK: "loopback",
    Command.READ_PAGE: "read program page",
    Command.WRITE_PAGE: "write program page",
    Command.DETAILED_STATUS: "read detailed status",
}


PROGRAM_COMMANDS: Final = frozenset({Command.READ_PAGE, Command.WRITE_PAGE})


class Control(IntEnum):
    """The operation of 42 on a discrete."""

    DISABLE = 1
    ENABLE = 2
    SET = 3
    RESET = 4


class Request(Value, Generic[A]):
    """One request to a PLC, with the type ``A`` of its answer.

    ``writes`` is True if the request changes something, so it must not be sent twice without a read-back.
    """

    __slots__ = ()
    command: ClassVar[Command]
    writes: ClassVar[bool] = False


@frozen
class ReadBriefStatus(Request["BriefStatus"]):
    """40: three status bytes."""

    command: ClassVar[Command] = Command.BRIEF_STATUS


@frozen
class RunStop(Request[None]):
    """41: RUN or STOP."""

    run: bool
    command: ClassVar[Command] = Command.RUN_STOP
    writes: ClassVar[bool] = True


@frozen
class ControlDiscrete(Request[None]):
    """42: disable, enable, set or reset one discrete."""

    control: Control
    element: Element
    command: ClassVar[Command] = Command.CONTROL_DISCRETE
    writes: ClassVar[bool] = True

    def __post_init__(self) -> None:
        _discrete(self.element, self.command)


@frozen
class ReadDisabled(Request[tuple[bool, ...]]):
    """43: for 1 to 256 consecutive discretes, True where one is **disabled**."""

    first: Element
    count: int
    command: ClassVar[Command] = Command.READ_DISABLED

    def __post_init__(self) -> None:
        _discrete_run(self.first, self.count, self.command)


@frozen
class ReadDiscretes(Request[tuple[bool, ...]]):
    """44: the state of consecutive discretes: 1 to 256 in FACON."""

    first: Element
    count: int
    command: ClassVar[Command] = Command.READ_DISCRETES

    def __post_init__(self) -> None:
        _discrete_run(self.first, self.count, self.command)


@frozen
class WriteDiscretes(Request[None]):
    """45: set the state of consecutive discretes: 1 to 256 in FACON."""

    first: Element
    values: tuple[bool, ...]
    command: ClassVar[Command] = Command.WRITE_DISCRETES
    writes: ClassVar[bool] = True

    def __post_init__(self) -> None:
        _discrete_run(self.first, len(self.values), self.command)


@frozen
class ReadRegisters(Request[tuple[int, ...]]):
    """46: consecutive words, unsigned: in FACON 1 to 64 of 16 bits or 1 to 32 of 32 bits."""

    first: Element
    count: int
    command: ClassVar[Command] = Command.READ_REGISTERS

    def __post_init__(self) -> None:
        _register_run(self.first, self.count, self.command)


@frozen
class WriteRegisters(Request[None]):
    """47: write consecutive words, unsigned: in FACON 1 to 64 of 16 bits or 1 to 32 of 32 bits."""

    first: Element
    values: tuple[int, ...]
    command: ClassVar[Command] = Command.WRITE_REGISTERS
    writes: ClassVar[bool] = True

    def __post_init__(self) -> None:
        _register_run(self.first, len(self.values), self.command)
        for place, value in enumerate(self.values):
            _fits(self.first.after(place), value)


@frozen
class ReadMixed(Request[tuple[int, ...]]):
    """48: elements of any kind, at most 64 words in total; a discrete reads as 0 or 1."""

    elements: tuple[Element, ...]
    command: ClassVar[Command] = Command.READ_MIXED

    def __post_init__(self) -> None:
        _mixed(self.elements, MAX_READ_WORDS, self.command)


@frozen
class WriteMixed(Request[None]):
    """49: elements of any kind with their values, at most 32 words in total."""

    items: tuple[tuple[Element, int], ...]
    command: ClassVar[Command] = Command.WRITE_MIXED
    writes: ClassVar[bool] = True

    def __post_init__(self) -> None:
        _mixed([element for element, _ in self.items], MAX_MIXED_WRITE_WORDS, self.command)
        for element, value in self.items:
            _fits(element, value)


@frozen
class Loopback(Request[bytes]):
    """4E: the PLC answers the data of the request, 0 to 256 characters."""

    data: bytes
    command: ClassVar[Command] = Command.LOOPBACK

    def __post_init__(self) -> None:
        if len(self.data) > MAX_LOOPBACK:
            raise UsageError(f"loopback: expected at most {MAX_LOOPBACK} characters, got {len(self.data)}")


@frozen
class ReadPage(Request[bytes]):
    """4F: one page of the program, 64 words, high byte first [E:page-order], as 128 bytes. Page 0: header."""

    page: int
    command: ClassVar[Command] = Command.READ_PAGE

    def __post_init__(self) -> None:
        _page(self.page)


@frozen
class WritePage(Request[None]):
    """50: write one page of the program, 128 bytes."""

    page: int
    data: bytes
    command: ClassVar[Command] = Command.WRITE_PAGE
    writes: ClassVar[bool] = True

    def __post_init__(self) -> None:
        _page(self.page)
        if len(self.data) != PAGE_BYTES:
            raise UsageError(f"program page {self.page}: expected {PAGE_BYTES} bytes, got {len(self.data)}")


@frozen
class ReadDetailedStatus(Request["DetailedStatus | RawStatus"]):
    """53: 64 status bytes, with the ladder size; raw bytes if no paper describes them."""

    command: ClassVar[Command] = Command.DETAILED_STATUS


def _discrete(element: Element, command: Command) -> None:
    if element.kind.bits != 1:
        raise UsageError(f"{command.words} ({command:02X}): expected a discrete (X Y M S T C), got {element}")


def _discrete_run(first: Element, count: int, command: Command) -> None:
    _discrete(first, command)
    _run(first, count, count, command)


def _register_run(first: Element, count: int, command: Command) -> None:
    if first.kind.bits == 1:
        raise UsageError(f"{command.words} ({command:02X}): expected a register or word, got {first}")
    _run(first, count, count, command)


def _run(first: Element, count: int, limit: int, command: Command) -> None:
    if not 1 <= count <= limit:
        expected = f"1 to {limit}" if limit >= 1 else "1 or more"
        raise UsageError(
            f"{command.words} ({command:02X}) from {first}: expected {expected} elements, got {count}"
        )
    first.after(count - 1)  # raises if the last one is out of range


def _mixed(elements: Sequence[Element], limit: int, command: Command) -> None:
    words = sum(element.kind.words for element in elements)
    if not 1 <= words <= limit:
        raise UsageError(
            f"{command.words} ({command:02X}): expected 1 to {limit} words in total "
            f"(32 bits count 2), got {words}"
        )


def _fits(element: Element, value: int) -> None:
    last = (1 << element.kind.bits) - 1
    if not 0 <= value <= last:
        raise UsageError(f"{element}: expected a value of 0 to {last}, got {value}", element=str(element))


def _page(page: int) -> None:
    if not 0 <= page <= _ONE_WORD:
        raise UsageError(f"program page: expected 0 to {_ONE_WORD}, got {page}")
