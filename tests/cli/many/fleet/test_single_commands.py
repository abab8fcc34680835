"""A fleet command gives for each PLC the exit code and the document of the single command."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.program.archive import save_backup
from tests.cli.many.fleet.gateway import plcs_of
from tests.cli.running import NEW, OLD
from tests.program.samples import backup

if TYPE_CHECKING:
    from tests.cli.many.fleet.gateway import Hall
    from tests.cli.running import Cli

TIMES = {"time", "created", "duration_s", "file"}
COMMANDS = {
    "status": ("fleet status", "status"),
    "status --brief": ("fleet status --brief", "status --brief"),
    "backup": ("fleet backup --dir backups", "backup own.json --known old.json"),
    "verify, the same": ("fleet verify", "verify old.json"),
    "verify, another": ("fleet verify", "verify new.json"),
    "snapshot": ("fleet snapshot --dir snapshots", "snapshot --spec press.toml"),
    "check": ("fleet check", "check"),
}


def constant(document: Any) -> Any:
    """A document without what differs from run to run: times, and the name of the file that is written."""
    if isinstance(document, dict):
        return {key: constant(value) for key, value in document.items() if key not in TIMES}
    if isinstance(document, str):
        return re.sub(r"^\d+\.\d+s", "", document)
    return [constant(each) for each in document] if isinstance(document, list) else document


@pytest.mark.parametrize(("many", "one"), COMMANDS.values(), ids=list(COMMANDS))
def test_the_document_is_that_of_the_single_command(cli: Cli, plant: Hall, many: str, one: str) -> None:
    for name, image in (("old", OLD), ("new", NEW)):
        save_backup(backup(image), Path(f"{name}.json"))
    Path("press.toml").write_text('[[item]]\nelement = "R0-R9"\n\n[[item]]\nelement = "R9000"\n')
    reference = "new" if "new" in one else "old"
    plant.write(press=f'reference = "{reference}.json"\nspec = "press.toml"\n')
    found = plcs_of(cli(*many.split(), "--select", "press", "--json").document("fleet"))["press"]
    single = cli(*one.split(), "-p", "press", "--json")
    expected = single.document(found["document"]["schema"].split(".")[1].split("/")[0])
    assert found["exit_code"] == single.code
    assert constant(found["document"]) == constant(expected)
