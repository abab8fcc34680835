"""One plan of two parts, a program and values: one copy, one question, each part known after a failure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import pytest

from fatektool.errors import LineError, PlcError, PlcNotReady, RestoreIncomplete, UsageError
from fatektool.jobs.elements.planned import PlannedValues, RegisterChange
from fatektool.jobs.programs.backup import backup
from fatektool.jobs.programs.rewrite import Rewrite
from fatektool.jobs.status import brief_or_none
from fatektool.jobs.write_back.plan import WritePlan
from fatektool.jobs.write_back.write import write_back
from fatektool.program.archive import load_backup
from fatektool.protocol.elements import Element
from tests.program.samples import program
from tests.rigs import WRITE_PAGE, Bench, Seen

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fatektool.jobs.write_back.write import Agree
    from fatektool.program.archive import Backup

OLD, NEW = program(400, seed=1), program(400, seed=2)
PAGES = len(OLD.pages)
COUNT = 100  # in two writes
WRITE_REGISTERS = "47"


@dataclass(frozen=True)
class Copy:
    """A copy of the program; of the values the test knows what they were."""

    what: ClassVar[str] = "program and values"
    key: ClassVar[str] = "safety_backup"

    present: Backup
    folder: Path | None

    def find(self, folder: Path) -> Path | None:
        found = sorted(folder.iterdir())
        return found[0] if found else None

    def save(self, folder: Path) -> Path:
        path = folder / "copy.json"
        path.write_bytes(self.present.to_bytes())
        return path


class Noted:
    """What a mark was told."""

    def __init__(self) -> None:
        self.notes: list[object] = []

    def begin(self, safety_copy: Path | None) -> None:
        self.notes.append(safety_copy)

    def end(self, *, complete: bool) -> None:
        self.notes.append(complete)


class Machine:
    """A PLC, to which a program and values are to be written."""

    def __init__(self, folder: Path, *, rollback: bool = False) -> None:
        self.folder = folder
        self.bench = Bench(OLD)
        self.bench.device.running = True
        self.bench.device.write_words("R", 0, [7] * COUNT)
        self.mark = Noted()
        self.rollback = rollback

    def plan(self) -> WritePlan:
        plc = self.bench.plc
        present = backup(plc, single_pass=True)
        values = self.values
        changes = [
            RegisterChange(Element("R", at), values[at], at + 1000)
            for at in range(COUNT)
            if values[at] != at + 1000
        ]
        parts = (
            Rewrite(plc, NEW, present, range(PAGES), running=self.bench.device.running),
            PlannedValues(plc, changes, brief_or_none(plc)),
        )
        copy = Copy(present, self.folder)
        return WritePlan(parts, copy, "the machine is not back", rollback=self.rollback)

    def write(self, agree: Agree = lambda _: None) -> Path | None:
        plan = self.plan()
        return write_back(self.bench.plc, plan, agree, mark=self.mark)

    @property
    def values(self) -> list[int]:
        return list(self.bench.device.read_words("R", 0, COUNT))

    @property
    def is_new(self) -> bool:
        return self.bench.pages == NEW.pages and self.values == [at + 1000 for at in range(COUNT)]

    @property
    def is_old(self) -> bool:
        return self.bench.pages == OLD.pages and self.values == [7] * COUNT

    def fail(self, command: str, number: int, error: BaseException) -> None:
        """Let a request fail after it was executed, the number-th of its command."""

        def after(seen: Seen) -> None:
            if (seen.command, seen.number) == (command, number):
                raise error

        self.bench.tap.after = after


def test_both_are_written_behind_one_question(tmp_path: Path) -> None:
    machine = Machine(tmp_path)
    asked: list[Path | None] = []

    def agree(copy: Path | None) -> None:
        assert machine.is_old
        assert copy is not None
        assert load_backup(copy).program == OLD
        asked.append(copy)

    assert machine.write(agree) == tmp_path / "copy.json"
    assert asked == [tmp_path / "copy.json"]
    assert machine.is_new
    assert not machine.bench.device.running
    assert machine.mark.notes == [tmp_path / "copy.json", True]


def test_a_no_leaves_nothing(tmp_path: Path) -> None:
    machine = Machine(tmp_path)

    def agree(_: Path | None) -> None:
        raise UsageError("no")

    with pytest.raises(UsageError, match="no"):
        machine.write(agree)
    assert machine.is_old
    assert machine.bench.device.running
    assert not list(tmp_path.iterdir())
    assert machine.mark.notes == []


def test_what_cannot_be_prepared_leaves_nothing(tmp_path: Path) -> None:
    machine = Machine(tmp_path)

    def agree(_: Path | None) -> None:
        machine.bench.device.rom_pack = True

    with pytest.raises(PlcNotReady, match="got a ROM pack since its program was read: nothing was written"):
        machine.write(agree)
    assert machine.is_old
    assert not list(tmp_path.iterdir())
    assert machine.mark.notes == []


@pytest.mark.parametrize(
    ("command", "number", "held"),
    [
        (WRITE_PAGE, 3, ["page 2: the new program", "page 0-1: written but not read back",
                         "page 3-7: the previous program", "R0-R99: the previous value"]),
        (WRITE_REGISTERS, 1, ["page 0-7: the new program", "R0-R63: uncertain",
                              "R64-R99: the previous value"]),
        (WRITE_REGISTERS, 2, ["page 0-7: the new program", "R0-R63: written but not read back",
                              "R64-R99: uncertain"]),
    ],
)  # fmt: skip
def test_each_part_says_what_the_plc_holds(
    tmp_path: Path, command: str, number: int, held: list[str]
) -> None:
    machine = Machine(tmp_path)
    machine.fail(command, number, LineError("the line broke"))
    with pytest.raises(RestoreIncomplete) as caught:
        machine.write()
    error = caught.value
    assert [f"{place}: {holds}" for place, holds in error.states] == held
    assert error.message == (
        f"the machine is not back (the line broke): {'; '.join(held)}; previous program and values saved "
        f"in {tmp_path / 'copy.json'}; the PLC's mode is STOP: do not switch it to RUN"
    )
    assert error.details["values_old"] == [
        span for span in ("R0-R99", "R64-R99") if f"{span}: the previous value" in held
    ]
    assert machine.mark.notes == [tmp_path / "copy.json"]
    machine.bench.client()
    assert machine.write() == tmp_path / "copy.json"  # the same again, with the copy of the first run
    assert machine.is_new
    assert load_backup(tmp_path / "copy.json").program == OLD


@pytest.mark.parametrize(("command", "number"), [(WRITE_PAGE, 3), (WRITE_REGISTERS, 1), (WRITE_REGISTERS, 2)])
@pytest.mark.parametrize("kind", [LineError, PlcError])
def test_all_parts_are_rolled_back(
    tmp_path: Path, command: str, number: int, kind: type[LineError | PlcError]
) -> None:
    machine = Machine(tmp_path, rollback=True)
    machine.fail(command, number, kind("it broke"))
    with pytest.raises(kind, match="it broke; rolled back: the PLC holds its previous program") as caught:
        machine.write()
    assert "and its previous values, read back and verified" in caught.value.message
    assert machine.is_old
    assert caught.value.details == {"rolled_back": True, "safety_backup": str(tmp_path / "copy.json")}
    assert machine.mark.notes == [tmp_path / "copy.json", False]


def test_a_rollback_that_fails_calls_uncertain_what_it_touched(tmp_path: Path) -> None:
    """Writing them back fails as well: some are the previous ones again, and none is certain."""
    machine = Machine(tmp_path, rollback=True)

    def after(seen: Seen) -> None:
        if seen.command == WRITE_REGISTERS and seen.number in {2, 4}:
            raise LineError("the line broke")

    machine.bench.tap.after = after
    with pytest.raises(RestoreIncomplete, match="; and rolling back failed: the line broke") as caught:
        machine.write()
    assert caught.value.details["values_uncertain"] == ["R0-R99"]
    assert caught.value.details["pages_written"] == list(range(PAGES))
    assert machine.bench.pages == NEW.pages


def test_ctrl_c_is_never_rolled_back(tmp_path: Path) -> None:
    machine = Machine(tmp_path, rollback=True)
    machine.fail(WRITE_REGISTERS, 1, KeyboardInterrupt())
    with pytest.raises(RestoreIncomplete, match="interrupted"):
        machine.write()
    assert machine.bench.pages == NEW.pages


def interrupted(safety_copy: Path | None) -> None:  # noqa: ARG001  # a mark's parameter
    raise KeyboardInterrupt


@pytest.mark.parametrize("when", ["agree", "prepare", "begin"])
def test_ctrl_c_before_the_first_request_that_writes(tmp_path: Path, when: str) -> None:
    machine = Machine(tmp_path)
    if when == "prepare":
        machine.fail("41", 1, KeyboardInterrupt())
    elif when == "begin":
        machine.mark.begin = interrupted  # type: ignore[method-assign]
    agree: Callable[[Path | None], object] = interrupted if when == "agree" else lambda _: None
    with pytest.raises(KeyboardInterrupt) as caught:
        machine.write(agree)
    doubt = "it is not known whether the PLC is in RUN or in STOP; nothing was written"
    said = {"agree": (), "prepare": (doubt,)}
    assert caught.value.args == said.get(when, caught.value.args)
    assert when != "begin" or str(caught.value).startswith("nothing was changed, the PLC holds its previous ")
    assert machine.is_old
    assert not list(tmp_path.iterdir())
    assert machine.mark.notes == ([False] if when == "begin" else [])
