"""``snapshot apply``: what differs, and no more; with a way back, and a way on."""

from __future__ import annotations

import json
import shlex
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.cli import run
from fatektool.errors import DataError, NoAnswer
from fatektool.exchange.link import Link
from fatektool.jobs.elements.reads import read_elements
from fatektool.jobs.elements.selection import parse_items
from fatektool.jobs.snapshots.apply import plan_apply
from fatektool.jobs.snapshots.formats import as_json
from fatektool.jobs.snapshots.snapshot import load_snapshot, take_all
from fatektool.jobs.snapshots.write_values import write_values
from fatektool.protocol.elements import Element
from fatektool.simulator.build import build_simulation
from tests.cli.terminal import Terminal
from tests.plant import Plant, cut_in_write, error_of, is_write, recorded, small, snapshot_of, spied

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.protocol.commands import Request
    from tests.rigs import Simulated


def safety(place: Path) -> list[Path]:
    return sorted(place.glob("*.safety-*"))


def filled() -> Simulated:
    """A PLC in whose memory every kind has something."""
    made = small()
    plc = made.plc
    for first, step in (("R0", 7), ("D5", 11), ("RT0", 3), ("RC0", 5), ("R3904", 2), ("R8008", 1)):
        plc.write_registers(Element.parse(first), [step * at & 0xFFFF for at in range(64)])
    for first in ("Y0", "M0", "S7", "T1", "C1", "M1950"):
        plc.write_discretes(Element.parse(first), [at % 3 == 0 for at in range(40)])
    made.device.set_input(5, 1)
    made.device.set_input_register(3850, 99)
    return made


def test_all_of_one_plc_makes_another_equal() -> None:
    one, other = filled(), small()
    snapshot = take_all(one.plc)
    other.plc.write_registers(Element("D", 3000), [1, 2, 3])
    other.plc.disable(Element("M", 3))
    plan = plan_apply(other.plc, snapshot)
    assert plan.inputs == ("X5",)
    failed = write_values(other.plc, plan.values).not_taken
    assert {str(each.element): each.reason[:14] for each in failed} == {
        "R3850": "acknowledged, ", "M3": "it is disabled",
    }  # fmt: skip
    for area in ("Y", "S", "T", "C"):
        assert one.device.memory.status[area] == other.device.memory.status[area]
    for area in ("D", "RT", "RC"):
        assert one.device.memory.registers[area] == other.device.memory.registers[area]
    other.device.set_input(5, 1)
    other.device.set_input_register(3850, 99)
    other.plc.set(Element("M", 3))
    assert one.device.memory.status == other.device.memory.status
    assert one.device.memory.registers == other.device.memory.registers
    again = plan_apply(other.plc, snapshot)
    assert (again.changes, again.inputs, again.refused) == ((), (), {})


def test_only_what_differs_is_written(plant: Plant, place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plant.write("R0-R99=5", "M0-M9=on", "D4:f32=1.5")
    assert plant.cli("snapshot", "R0-R99", "M0-M9", "D4:f32", "X0", "-o", "monday.json").code == 0
    plant.write("R7=6", "M3=off", "D4:f32=2.5", "D100=1")
    plant.change(inputs={0: 1})
    changes = [("R7", 6, 5), ("M3", False, True), ("D4", 2.5, 1.5)]
    sent = recorded(monkeypatch)
    document = plant.json("apply", "snapshot", "apply", "monday.json", "--dry-run")
    assert [(each["key"], each["from"], each["to"]) for each in document["changes"]] == changes
    assert (document["written"], document["safety_snapshot"]) == (0, None)
    assert not any(map(is_write, sent))
    assert not safety(place)
    done = plant.cli("snapshot", "apply", "monday.json", "--dry-run", "-q")
    facts, (*rest,) = done.out.splitlines()[:6], done.out.splitlines()[6:]
    assert [line.split()[0] for line in facts] == ["PLC", "model", "mode", "file", "from", "time"]
    assert rest == [
        "R7  6 -> 5", "M3  off -> on", "D4  2.5 -> 1.5", "Previous values will be saved first.",
        "dry run: nothing was written",
    ]  # fmt: skip
    document = plant.json("apply", "snapshot", "apply", "monday.json", "--yes")
    assert document["written"] == 3
    assert document["not_written"] == ["X0"]
    (kept,) = safety(place)
    assert document["safety_snapshot"] == kept.name
    assert load_snapshot(kept).values["D4"] == 2.5
    assert plant.register(7) == 5
    assert plant.device.read_words("D", 100, 1) == [1]
    done = plant.cli("snapshot", "apply", "monday.json", "--yes")
    assert (done.code, done.out) == (0, "nothing to write: all else is the same\n")
    assert len(safety(place)) == 1
    back = plant.cli("snapshot", "apply", kept.name, "--yes", "--no-safety-snapshot")
    assert back.code == 0
    assert "NOT saved" in back.err
    assert plant.register(7) == 6


def test_the_safety_snapshot_is_on_disk_before_the_first_write(
    plant: Plant, place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plant.write("R1=1")
    assert plant.cli("snapshot", "R0-R9", "-o", "monday.json").code == 0
    plant.write("R1=2")
    seen: list[object] = []

    def before(data: bytes) -> None:
        if is_write(data):
            (kept,) = safety(place)
            seen.append(load_snapshot(kept).values["R1"])

    spied(monkeypatch, before)
    assert plant.cli("snapshot", "apply", "monday.json", "--yes").code == 0
    assert seen == [2]


def test_overlapping_views_are_written_once() -> None:
    made = small()
    made.plc.write_registers(Element("R", 0), [1, 2, 3, 4])
    made.plc.write_registers(Element("RC", 0), [1, 2])
    made.plc.write_discretes(Element("M", 0), [True] * 40)
    snapshot = snapshot_of(
        "R0-R2", "DR0", "DR1", "DR2", "WM0", "WM8", "DWM0", "M3", "DRC0", "RC1", "DRT0", "RT0", plc=made
    )
    other = small()
    plan = plan_apply(other.plc, snapshot)
    assert write_values(other.plc, plan.values).not_taken == []
    assert not plan_apply(other.plc, snapshot).changes
    assert other.plc.read_registers(Element("R", 0), 4) == (1, 2, 3, 4)
    other.plc.write_registers(Element("R", 1), [9])  # within DR0 and DR1
    again = plan_apply(other.plc, snapshot)
    assert [key for key, *_ in again.changes] == ["R1", "DR0", "DR1"]
    assert write_values(other.plc, again.values).not_taken == []


def test_a_snapshot_that_says_two_things_is_refused(plant: Plant, place: Path) -> None:
    document = json.loads(as_json(snapshot_of("R0", "DR0")))
    document["values"]["R0"] = 1
    document["elements"]["R0"]["raw"] = "0001"
    (place / "two.json").write_text(json.dumps(document))
    assert "two things of R0: R0 and DR0" in error_of(plant.cli("snapshot", "apply", "two.json", "--yes"), 5)
    assert plant.cli("snapshot", "apply", "two.json", "--yes", "--only", "R0").code == 0
    assert plant.register(0) == 1


def test_what_the_plc_refuses_is_named_and_the_rest_is_written(plant: Plant, place: Path) -> None:
    larger = small(model="fbs-20mc")
    larger.plc.write_registers(Element("D", 3070), [1, 2, 3, 4])
    larger.plc.write_registers(Element("R", 0), [5])
    larger.plc.write_discretes(Element("Y", 3), [True])
    larger.device.set_input(0, 1)
    larger.device.set_input_register(3840, 7)
    words = ["D3070-D3073", "R0", "Y3", "X0", "R3840", "F0", "R9000"]
    (place / "large.json").write_text(as_json(snapshot_of(*words, plc=larger)))
    assert plant.cli("discrete", "disable", "Y3").code == 0
    document = plant.json("apply", "snapshot", "apply", "large.json", "--yes", code=4)
    reasons = {each["key"]: each["reason"] for each in document["not_taken"]}
    assert set(reasons) == {"D3072", "D3073", "F0", "R3840", "Y3"}
    assert "illegal address" in reasons["D3072"]
    assert "disabled" in reasons["Y3"]
    assert "read-only" in reasons["R3840"]
    assert document["not_written"] == ["X0", "R9000"]
    assert document["written"] == 3
    assert plant.device.read_words("D", 3070, 2) == [1, 2]
    again = plant.cli("snapshot", "apply", "large.json", "--yes")
    assert again.code == 4
    assert "warning: not written: X0: inputs follow their terminals" in again.err
    assert "warning: not written: R9000: no value in the snapshot" in again.err
    assert "warning: D3072: not written: the PLC refused" in again.err
    assert "warning: Y3: not kept: expected 1 in Y3, read back 0: it is disabled" in again.err


def test_names_of_a_specification(plant: Plant, place: Path) -> None:
    (place / "spec.toml").write_text(
        '[[item]]\nelement="R1"\nname="oil, \\"hot\\""\nscale=0.1\nunit="°C"\n'
        '[[item]]\nelement="R3840-R3841"\nname="in"\n'
    )
    plant.write("R1=215")
    assert plant.cli("snapshot", "--spec", "spec.toml", "-o", "a.json").code == 0
    plant.write("R1=220")
    simulation = build_simulation(state=plant.state)
    simulation.plcs[1].set_input_register(3841, 5)
    simulation.save_if_changed()
    done = plant.cli("snapshot", "apply", "a.json", "--yes")
    assert done.code == 4
    assert 'oil, "hot"  22 -> 21.5' in done.err
    assert "warning: in[1]: not kept: expected 0000 in R3841, read back 0005" in done.err
    assert plant.cli("snapshot", "apply", "a.json", "--yes", "--only", "oil*").code == 0
    error_of(plant.cli("snapshot", "apply", "a.json", "--yes", "--only", "water*"), 5)


def test_it_asks(plant: Plant, place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (place / "a.json").write_text(as_json(snapshot_of("R0")))
    plant.write("R0=1")
    alone = plant.cli("snapshot", "apply", "a.json")
    assert (alone.code, "--yes" in alone.err.splitlines()[-1]) == (2, True)
    assert not safety(place)
    monkeypatch.setattr("fatektool.cli.shared.questions.can_ask", lambda: True)
    monkeypatch.setattr("sys.stdin.readline", lambda: "n\n", raising=False)
    done = plant.cli("snapshot", "apply", "a.json")
    assert done.code == 2
    assert "R0  1 -> 0" in done.err
    assert done.err.endswith("? [y/N]: fatektool: Aborted. Nothing was written.\n")
    assert plant.register(0) == 1
    assert not safety(place)  # nothing needs a way back


def test_on_a_terminal(plant: Plant, place: Path) -> None:
    (place / "a.json").write_text(as_json(snapshot_of("R0")))
    plant.write("R0=1")
    with Terminal("snapshot", "apply", "a.json", "-p", plant.target) as terminal:
        terminal.read_until("[y/N]")
        assert "R0  1 -> 0" in terminal.text
        assert len(safety(place)) == 1
        assert plant.register(0) == 1
        terminal.type("y\n")
        assert terminal.end() == 0
    assert "1 of 1 value written and read back" in terminal.text
    assert plant.register(0) == 0


def test_in_run_it_warns(plant: Plant, place: Path) -> None:
    (place / "a.json").write_text(as_json(snapshot_of("R0")))
    plant.change(running=True)
    assert "in RUN" not in plant.cli("snapshot", "apply", "a.json", "--yes").err
    plant.write("R0=1")
    done = plant.cli("snapshot", "apply", "a.json", "--yes")
    assert done.code == 0
    assert "warning: the PLC is in RUN: its program may change the values again" in done.err


@pytest.mark.parametrize("writes", [0, 1, 2, 3, 4])
def test_a_line_that_is_cut_is_finished_by_the_same_command(
    plant: Plant, place: Path, monkeypatch: pytest.MonkeyPatch, writes: int
) -> None:
    plant.write("R0-R255=1")
    assert plant.cli("snapshot", "R0-R255", "-o", "monday.json").code == 0
    plant.write("R0-R255=2")
    with monkeypatch.context() as patch:
        cut_in_write(patch, writes)
        # the fourth write ends the job: cut in the read-back instead
        document = plant.json("error", "snapshot", "apply", "monday.json", "--yes", code=6)["error"]
    (first,) = safety(place)
    assert document["details"]["safety_snapshot"] == first.name
    assert load_snapshot(first).values["R255"] == 2
    words = shlex.split(document["details"]["command"])
    assert words == [
        "fatektool", "snapshot", "apply", "-p", plant.target, "monday.json", "--yes", "--json",
    ]  # fmt: skip
    assert document["details"]["command"] in document["hint"]
    done = plant.cli(*words[1:-1])
    assert done.code == 0
    assert [plant.register(at) for at in (0, 100, 255)] == [1, 1, 1]
    assert plant.cli("snapshot", "apply", first.name, "--yes").code == 0
    assert [plant.register(at) for at in (0, 100, 255)] == [2, 2, 2]


def test_the_message_of_a_cut_line(plant: Plant, place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (place / "a.json").write_text(as_json(snapshot_of("R0-R99")))
    plant.write("R0-R99=2")
    cut_in_write(monkeypatch, 1)
    done = plant.cli("snapshot", "apply", "a.json", "--yes", "--safety-dir", ".")
    assert done.code == 6
    *_, headline, plc, cause, new, old, saved, fix, command = done.err.splitlines()
    assert headline == "fatektool: the snapshot was not applied completely"
    assert plc.split(maxsplit=1) == ["PLC", f"station 1 on {plant.target}"]
    assert cause.split()[0] == "cause"
    assert new == "  R0-R63           uncertain"
    assert old == "  R64-R99          the previous value"
    assert saved.split() == ["previous", "values", "saved", "in", safety(place)[0].name]
    assert fix == "fix the cause, then run:"
    assert command.startswith(f"fatektool snapshot apply -p {plant.target} a.json --yes")


def test_an_interrupt_in_the_middle(plant: Plant, place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (place / "a.json").write_text(as_json(snapshot_of("R0-R99")))
    plant.write("R0-R99=2")

    ask = Link.ask

    def interrupted(link: Link, request: Request[Any]) -> Any:
        if not request.writes:
            return ask(link, request)
        link.counters.writes += 1
        raise KeyboardInterrupt

    monkeypatch.setattr(Link, "ask", interrupted)
    done = plant.cli("snapshot", "apply", "a.json", "--yes")
    assert done.code == 6
    assert "  cause            interrupted" in done.err.splitlines()


def test_no_answer_before_the_first_write(plant: Plant, place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing was written: that is a line error, and there is nothing to go back to."""
    (place / "a.json").write_text(as_json(snapshot_of("R0")))
    plant.write("R0=2")

    def silent(*_: object) -> None:
        raise NoAnswer("no answer from station 1")

    monkeypatch.setattr("fatektool.jobs.elements.planned.write_elements", silent)
    done = plant.cli("snapshot", "apply", "a.json", "--yes")
    assert done.code == 3
    assert "may have been written" not in done.err
    assert not safety(place)


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["none.json"], 2), (["bad.json"], 5), (["a.json", "--safety-dir", "bad.json"], 2), ([], 2),
        (["a.json", "--safety-dir", ".", "--no-safety-snapshot"], 2), (["."], 2),
        (["a.json", "-p", "/dev/none"], 3),
    ],
)  # fmt: skip
def test_what_cannot_be(plant: Plant, place: Path, words: list[str], code: int) -> None:
    (place / "a.json").write_text(as_json(snapshot_of("R0")))
    (place / "bad.json").write_bytes(b"\xff" * 100)
    error_of(plant.cli("snapshot", "apply", *words, "--yes"), code)


def test_a_snapshot_without_a_match() -> None:
    with pytest.raises(DataError, match="no key"):
        plan_apply(small().plc, snapshot_of("R0"), ["x*"])


def test_a_very_long_name_leaves_room_for_the_safety_snapshot(plant: Plant, place: Path) -> None:
    name = "ü" * 120 + ".json"
    (place / name).write_text(as_json(snapshot_of("R0")))
    plant.write("R0=1")
    assert plant.cli("snapshot", "apply", name, "--yes").code == 0
    assert len(safety(place)) == 1
    assert run(["snapshot", "diff", name, str(safety(place)[0])]) == 1
    plant.cli("status")


def test_ndjson_is_applied_from_its_last_line(plant: Plant, place: Path) -> None:
    plant.write("R0=1")
    assert plant.cli("snapshot", "R0", "--append", "a.ndjson").code == 0
    plant.write("R0=2")
    assert plant.cli("snapshot", "R0", "--append", "a.ndjson").code == 0
    plant.write("R0=3")
    with (place / "a.ndjson").open("a") as file:
        file.write('{"schema":"fatektool.snapsh')
    done = plant.cli("snapshot", "apply", "a.ndjson", "--yes")
    assert done.code == 0
    assert "the last line is incomplete" in done.err
    assert plant.register(0) == 2
    assert read_elements(small().plc, [parse_items(["R0"])[0].element]).errors == {}
