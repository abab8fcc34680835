"""Targets that are nearly right, on the command line."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.rows import each

if TYPE_CHECKING:
    from pathlib import Path

    from tests.cli.running import Cli


@each(
    ("target", "code", "said"),
    [
        ("192.168.2.3", 3, "192.168.2.3: no such port; did you mean tcp://192.168.2.3?"),
        ("127.0.0.1:5500", 3, "did you mean tcp://127.0.0.1:5500?"),
        ("sim", 3, "did you mean sim:?"),
        ("press", 3, "press: no such port; for the name of a PLC there must be an inventory"),
        ("tcp:192.168.2.3", 2, "did you mean tcp://192.168.2.3?"),
        ("http://192.168.2.3", 2, "did you mean tcp://192.168.2.3?"),
    ],
)
def test_a_command_says_it(cli: Cli, target: str, code: int, said: str) -> None:
    done = cli("status", "-p", target)
    assert (done.code, done.out) == (code, "")
    assert said in done.err


def test_an_inventory_without_the_name_says_it_too(cli: Cli, tmp_path: Path) -> None:
    inventory = tmp_path / "plant.toml"
    inventory.write_text('[plc.press]\ntarget = "sim:"\n', encoding="utf-8")
    done = cli("status", "-p", "192.168.2.3", "--inventory", str(inventory))
    assert (done.code, "did you mean tcp://192.168.2.3?" in done.err) == (2, True)
    done = cli("status", "-p", "prest", "--inventory", str(inventory))
    assert "did you mean press?" in done.err
