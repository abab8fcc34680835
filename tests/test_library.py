"""The library: what is public, what it does, and docs/library.md with an example of each name that runs."""

from __future__ import annotations

import ast
import doctest
import inspect
import re
from typing import TYPE_CHECKING, Any, get_args

import click
import pytest

import fatektool
from fatektool.errors import FatektoolError
from fatektool.inventory.find import configuration_folder
from fatektool.protocol.values import Value
from tests.project.files import ELEMENTS, IMAGE, project_file
from tests.root import DOCS, EXAMPLES
from tests.rows import each

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

PAGE = (DOCS / "library.md").read_text(encoding="utf-8")
_SECTION = re.compile(r"^##+ (.+?)$(.*?)(?=^##|\Z)", re.MULTILINE | re.DOTALL)
SECTIONS = {title.replace("\\", ""): text for title, text in _SECTION.findall(PAGE)}
FUNCTIONS = [name for name in fatektool.__all__ if inspect.isfunction(getattr(fatektool, name))]


def signature_of(function: Any) -> str:
    """As a person writes it: no addresses of functions, no whole paths of types."""
    text = re.sub(r"<function (\w+) at 0x[0-9a-f]+>", r"\1", str(inspect.signature(function)))
    text = re.sub(r"RestoreOptions\([^)]*\)", "RestoreOptions()", text)
    return bare(text.replace("operands.Spoken", "Spoken").replace("(self, ", "("))


def bare(text: str) -> str:
    """On one line, without quotes, which an annotation has or has not."""
    return re.sub(r"[\"']", "", " ".join(text.split()))


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where the examples of the page are run."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(tmp_path))
    monkeypatch.delenv("FATEKTOOL_INVENTORY", raising=False)
    (inventory,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "fatek.toml").write_text(inventory, encoding="utf-8")
    return tmp_path


# --- the page ---------------------------------------------------------------------------------------------


def examples(title: str) -> list[str]:
    return re.findall(r"```python\n(.*?)```", SECTIONS[title], re.DOTALL)


@pytest.mark.parametrize("title", [title for title in SECTIONS if examples(title)])
def test_the_examples_run(title: str, folder: Path) -> None:
    with fatektool.connect("sim:") as plc:
        fatektool.save_backup(fatektool.backup(plc), "press.json")
    project_file("press.pdw", IMAGE, elements=ELEMENTS)
    for number, text in enumerate(examples(title)):
        assert ">>> " in text
        example = doctest.DocTestParser().get_doctest(text, {}, f"{title} {number}", "library.md", 0)
        said: list[str] = []
        failed, _ = doctest.DocTestRunner(verbose=False).run(example, out=said.append)
        assert not failed, "".join(said)
    assert folder.exists()


def test_every_public_name_has_an_example() -> None:
    for name in fatektool.__all__:
        assert name in SECTIONS, f"{name}: no section in docs/library.md"
        assert any(f"fatektool.{name}" in text or name == "Plc" for text in examples(name)), name


def test_every_function_has_its_signature_and_its_errors() -> None:
    for name in FUNCTIONS:
        words = bare(SECTIONS[name])
        assert name + signature_of(getattr(fatektool, name)) in words, name
        assert "Raises: " in words, name
    for name in ("read", "write"):
        assert name + signature_of(getattr(fatektool.Plc, name)) in bare(SECTIONS["Plc"])
    fields = signature_of(fatektool.PlcAddress).removesuffix(" -> None")
    assert f"PlcAddress{fields}" in bare(SECTIONS["PlcAddress"])


def test_the_page_names_the_types_of_a_value() -> None:
    assert " | ".join(kind.__name__ for kind in get_args(Value)) in SECTIONS["Plc"]


# --- what is public ---------------------------------------------------------------------------------------


def test_dir_shows_what_is_meant_to_be_used() -> None:
    assert dir(fatektool) == sorted(fatektool.__all__)
    assert all(hasattr(fatektool, name) for name in fatektool.__all__)
    assert not hasattr(fatektool, "client_of_another_kind")


def attributes(tree: ast.AST) -> Iterator[str]:
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Attribute)
            and isinstance(node.value, ast.Name)
            and node.value.id == "fatektool"
        ):
            yield node.attr


def test_the_examples_use_public_names_alone() -> None:
    scripts = sorted(EXAMPLES.rglob("*.py"))
    assert len(scripts) >= 4
    for path in scripts:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        assert set(attributes(tree)) <= set(fatektool.__all__), path.name
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom):
                assert not (node.module or "").startswith("fatektool"), f"{path.name}: {node.module}"
            if isinstance(node, ast.Import):
                assert not [alias for alias in node.names if alias.name.startswith("fatektool.")], path.name


# --- values by name ---------------------------------------------------------------------------------------


def test_values_are_read_and_written_by_name() -> None:
    with fatektool.simulate() as simulated, fatektool.connect(simulated.target, timeout_s=20) as plc:
        plc.write({"R12": -5, "DR14": -1, "Y0": True, "D4:f32": 1.5, "R0-R2": [1, 2, 3], "WM8": "0x5555"})
        plc.write({"R30:hex": 0xBEEF, "R31:hex": "0A", "R32:bcd": 42, "R33:2": 9, "Y1": 1, "Y2": "off"})
        found = plc.read("R12", "DR14", "Y0-Y2", "D4:f32", "R0:3", "WM8", fatektool.Element("R", 34))
        assert found == {
            "R12": -5, "DR14": -1, "Y0": True, "Y1": True, "Y2": False, "D4": 1.5, "R0": 1, "R1": 2, "R2": 3,
            "WM8": 0x5555, "R34": 9,
        }  # fmt: skip
        assert plc.read("R30:hex", "R31:hex", "R32:bcd") == {"R30": "BEEF", "R31": "000A", "R32": 42}
        assert simulated.plcs[1].read_words("R", 12, 1) == [65531]


NO_ELEMENT: Any = 12


@each(
    ("call", "message"),
    [
        (lambda plc: plc.read(), "read: expected elements, such as 'R12' or 'X0-X7', got none"),
        (lambda plc: plc.read("R1", 12), "read: argument 2: expected an element such as 'R12', got 12"),
        (lambda plc: plc.read("R12:f99"), "'R12:f99': unknown type 'f99'"),
        (lambda plc: plc.write({}), "write: expected values by element"),
        (lambda plc: plc.write("R12=5"), "write: expected values by element"),
        (lambda plc: plc.write({12: 5}), "write: expected an element such as 'R12', got 12"),
        (lambda plc: plc.write({"R12": True}), "R12: value 'True': expected a whole number"),
        (lambda plc: plc.write({"R12": 1.5}), "R12: value '1.5': expected a whole number"),
        (lambda plc: plc.write({"R12": None}), "R12: expected a number, a bool, text or a list"),
        (lambda plc: plc.write({"R0:2": [1, 2, 3]}), "R0:2: expected 1 value or 2, got 3"),
        (lambda plc: plc.write({"Y0": 5}), "Y0: value '5': expected on or off"),
        (lambda plc: plc.write({"R1": 1, "DR0": 1}), "R1 and DR0 overlap"),
        (lambda plc: plc.write({"D4:f32": float("nan")}), "D4: value 'nan': expected a number"),
        (lambda plc: plc.read_registers(12, 1), "expected an element such as 'R12', got 12"),
        (lambda plc: plc.read_registers("R12", 200), "read registers (46) from R12: expected 1 to 64"),
        (lambda _: fatektool.connect("sim:", station=300), "station: expected a whole number"),
        (lambda _: fatektool.connect(NO_ELEMENT), "target: expected a string"),
    ],
)  # fmt: skip
def test_an_error_names_the_argument(call: Any, message: str) -> None:
    with fatektool.connect("sim:") as plc, pytest.raises(fatektool.UsageError) as caught:
        call(plc)
    assert caught.value.message.startswith(message)
    assert plc.link.counters.exchanges == 0


def test_what_the_plc_refuses_or_does_not_keep_is_an_error_by_name() -> None:
    with fatektool.connect("sim:") as plc:
        plc.write({"R1": 7})
        with pytest.raises(fatektool.PlcError, match=r"^R60000: .*; and 1 more: see details") as caught:
            plc.read("R60000", "R1", "R60001")
        assert caught.value.details["values"] == {"R60000": None, "R1": 7, "R60001": None}
        with pytest.raises(
            fatektool.PlcError, match="X0: not kept: expected True, read back False"
        ) as caught:
            plc.write({"X0": True, "R1": 8})
        assert list(caught.value.details["errors"]) == ["X0"]
        assert plc.read("R1") == {"R1": 8}


def test_a_line_that_fails_half_way_says_that_values_may_be_written() -> None:
    with fatektool.simulate(faults=["drop=1"]) as simulated:
        plc = fatektool.connect(simulated.target, timeout_s=0.01, retries=0)
        with plc, pytest.raises(fatektool.LineError) as caught:
            plc.write({"R0": 1, "Y5": True})
    assert "values may have been written" in str(caught.value)


# --- the inventory ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("value", ["1", "true", "ON", " yes "])
def test_connect_obeys_the_environment_that_says_read_only(
    folder: Path, monkeypatch: pytest.MonkeyPatch, value: str
) -> None:
    assert (folder / "fatek.toml").exists()
    monkeypatch.setenv("FATEKTOOL_READ_ONLY", value)
    address = fatektool.PlcAddress("sim:", read_only=False)
    for opened in (
        fatektool.connect("sim:"),
        fatektool.connect("sim:", read_only=False),
        fatektool.connect(address),
        fatektool.connect("hall-1"),
    ):
        with opened as plc:
            with pytest.raises(fatektool.errors.LineReadOnly):
                plc.write({"R1": 5})
            with pytest.raises(fatektool.errors.LineReadOnly):
                plc.run()
            assert plc.read("R1") == {"R1": 0}


def test_other_values_of_that_variable(monkeypatch: pytest.MonkeyPatch) -> None:
    for nothing in ("", "0", "False", "no", "off"):
        monkeypatch.setenv("FATEKTOOL_READ_ONLY", nothing)
        with fatektool.connect("sim:") as plc:
            plc.write({"R1": 5})
    monkeypatch.setenv("FATEKTOOL_READ_ONLY", "maybe")
    with pytest.raises(fatektool.UsageError, match="FATEKTOOL_READ_ONLY: expected 1 or 0, got 'maybe'"):
        fatektool.connect("sim:")


def test_connect_knows_the_inventory(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    other = folder / "other.toml"
    other.write_text('[plc.oven]\ntarget = "sim:"\nstation = 7\nread_only = true\n', encoding="utf-8")
    with fatektool.connect("hall-1", retries=1) as plc:
        assert (plc.target, plc.station, plc.link.retries) == ("sim:hall.state", 1, 1)
    with pytest.raises(fatektool.UsageError, match="no PLC 'oven' in the inventory"):
        fatektool.connect("oven")
    with fatektool.connect("oven", inventory=str(other)) as plc:
        assert plc.station == 7
        with pytest.raises(fatektool.LineReadOnly):
            plc.write({"R0": 1})
    monkeypatch.setenv("FATEKTOOL_INVENTORY", str(other))
    with fatektool.connect("oven") as plc:
        assert plc.station == 7
    other.write_text("[plc.oven]\ntarget = 5\n", encoding="utf-8")
    with pytest.raises(fatektool.DataError):
        fatektool.connect("oven")
    with fatektool.connect("sim:") as plc:  # a port needs no inventory
        assert plc.is_open


def test_the_users_folder_is_that_of_the_command_line() -> None:
    assert configuration_folder() == click.get_app_dir("fatektool")


def test_every_error_is_public_or_a_kind_of_one() -> None:
    public = tuple(
        value for name in fatektool.__all__
        if inspect.isclass(value := getattr(fatektool, name)) and issubclass(value, FatektoolError)
    )  # fmt: skip
    assert {kind.exit_code for kind in public} == {70, 2, 3, 4, 5, 6}
