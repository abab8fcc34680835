"""Every example runs, against simulated PLCs, as its first lines say."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from fatektool.connection import connect
from fatektool.protocol.elements import Element
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server, running
from tests.forks.shell import path as shell_path
from tests.root import EXAMPLES


def run(folder: Path, *command: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"PATH": shell_path(), "FATEKTOOL_LOCK_DIR": str(folder)}
    environment.pop("PYTEST_ADDOPTS", None)  # they are for the tests around this one
    environment["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


def backup_of_seed(folder: Path, seed: int) -> Path:
    """A backup of another demonstration program."""
    from fatektool.jobs.programs.backup import backup
    from fatektool.program.archive import save_backup
    from tests.rigs import simulated

    path = folder / f"seed{seed}.json"
    save_backup(backup(simulated(ladder_words=13184, program_seed=seed).plc), path)
    return path


def test_every_example_is_listed_and_tested() -> None:
    listed = (EXAMPLES / "README.md").read_text(encoding="utf-8")
    here = Path(__file__).read_text(encoding="utf-8")
    for path in EXAMPLES.iterdir():
        if path.suffix in {".py", ".sh"}:
            assert f"`{path.name}`" in listed
            assert path.name in here


@pytest.mark.skipif(shutil.which("bash") is None, reason="a shell script needs a shell")
def test_tour(tmp_path: Path) -> None:
    done = run(tmp_path, str(EXAMPLES / "tour.sh"), "sim:demo.state")
    assert done.returncode == 0, done.stderr
    assert "the PLC holds what is on file" in done.stdout
    assert "the PLC is in RUN" in done.stdout
    assert (tmp_path / "press.json").exists()


@pytest.mark.skipif(shutil.which("bash") is None, reason="a shell script needs a shell")
def test_tour_tells_of_a_dead_line(tmp_path: Path) -> None:
    done = run(tmp_path, str(EXAMPLES / "tour.sh"), "/dev/ttyNOTHERE")
    assert done.returncode == 3
    assert "no such port" in done.stderr


def test_backup_and_compare(tmp_path: Path) -> None:
    script = str(EXAMPLES / "backup_and_compare.py")
    first = run(tmp_path, sys.executable, script, "sim:demo.state", ".")
    assert first.returncode == 0, first.stderr
    assert "kept as" in first.stdout
    second = run(tmp_path, sys.executable, script, "sim:demo.state", ".")
    assert "no change since" in second.stdout


def test_restore_with_questions(tmp_path: Path) -> None:
    script = str(EXAMPLES / "restore_with_questions.py")
    other = backup_of_seed(tmp_path, 2)
    refused = run(tmp_path, sys.executable, script, "sim:demo.state", str(other))
    assert refused.returncode == 2
    assert "Aborted" in refused.stderr
    same = backup_of_seed(tmp_path, 1)
    done = run(tmp_path, sys.executable, script, "sim:demo.state", str(same))
    assert done.returncode == 0, done.stderr
    assert "0 pages written, PLC in RUN" in done.stdout


@pytest.mark.parametrize("name", ["backup_and_compare.py", "restore_with_questions.py"])
def test_words_that_are_missing(tmp_path: Path, name: str) -> None:
    done = run(tmp_path, sys.executable, str(EXAMPLES / name), "sim:demo.state")
    assert done.returncode == 1
    assert f"Usage: python {name} TARGET" in done.stderr
    assert "Traceback" not in done.stderr


def test_my_client(tmp_path: Path) -> None:
    shutil.copy(EXAMPLES / "test_my_client.py", tmp_path)  # away from this project's settings
    done = run(tmp_path, sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider")
    assert done.returncode == 0, done.stdout


def test_own_socket(tmp_path: Path) -> None:
    server = Server(build_simulation())
    host, port = server.open_tcp().address.removeprefix("tcp://").split(":")
    script = str(EXAMPLES / "own_socket.py")
    with running(server), connect(f"tcp://{host}:{port}", timeout_s=5) as plc:
        plc.write_registers(Element.parse("R5"), [7, 65535])
        plc.close()
        done = run(tmp_path, sys.executable, script, host, port, "R5", "2")
        assert (done.returncode, done.stdout) == (0, "7 65535\n"), done.stderr
        refused = run(tmp_path, sys.executable, script, host, port, "R60000", "1")
        assert "the PLC refused: illegal address" in refused.stderr
    assert "usage: " in run(tmp_path, sys.executable, script).stderr
