"""The nightly comparison of what runs with the engineer's project, as cron does it."""

from __future__ import annotations

import re
import shutil
import tomllib
from pathlib import Path

import pytest

from tests.cli.many.fleet.test_operations import shell
from tests.cli.programs.test_diff import NEGATED
from tests.cli.running import served
from tests.project.files import IMAGE, program_of, project_file
from tests.root import ROOT

EXAMPLE = (ROOT / "examples" / "crontab-projects").read_text(encoding="utf-8")


@pytest.mark.skipif(shutil.which("bash") is None, reason="cron starts a shell")
def test_the_mail_says_which_networks(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    project_file("press.pdw", IMAGE)
    entry = "\n".join(re.findall(r"^#   ((?:reference|project|tags) = .*)", EXAMPLE, re.MULTILINE))
    assert tomllib.loads(entry).keys() == {"reference", "project", "tags"}
    (job,) = (line.split(None, 5)[5] for line in EXAMPLE.splitlines() if re.match(r"\d", line))
    monkeypatch.setenv("FATEKTOOL_INVENTORY", str(place / "fatek.toml"))
    for image, code in ((IMAGE, 0), (NEGATED, 1)):
        with served(program_of(image)) as plc:
            Path("fatek.toml").write_text(
                f'[plc.press]\ntarget = "{plc.target}"\n{entry}\n[plc.oven]\ntarget = "sim:"\n',
                encoding="utf-8",
            )
            done = shell(job)
        assert (done.returncode, done.stderr) == (code, "")
        if image is IMAGE:
            assert done.stdout == ""  # and so cron mails nothing
        else:
            assert re.fullmatch(
                r"press  differs .*press\.pdw: N0000 changed, 2 words in 2 pages\n", done.stdout
            )
