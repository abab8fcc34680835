"""Simulated PLCs, command lines, processes and terminals for the tests of the command line."""

from __future__ import annotations

import json
import os
import subprocess
from contextlib import contextmanager
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any, NamedTuple

from jsonschema import Draft202012Validator

from fatektool.cli import run
from fatektool.program.archive import save_backup
from fatektool.program.image import Program
from fatektool.simulator.build import Simulation, build_simulation
from fatektool.simulator.listen.servers import Server
from tests.forks.command import CAN_FORK, COMMAND, PIPE, Forked, Process
from tests.hurry import hurried
from tests.program.samples import backup, program

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    import pytest

OLD, NEW = program(400, seed=1), program(400, seed=2)
PAGES = 8


class Done(NamedTuple):
    """A command that has ended."""

    code: int
    out: str
    err: str

    def document(self, schema: str) -> Any:
        """The one JSON document on stdout, checked."""
        found = json.loads(self.out, parse_constant=lambda text: 1 / 0)  # noqa: ARG005  # no NaN
        check(found, schema)
        return found


def schema_text(name: str) -> str:
    return (files("fatektool") / "schemas" / f"{name}.json").read_text(encoding="utf-8")


def check(document: Any, schema: str) -> None:
    """Check a document against the schema that its name calls for."""
    assert document["schema"].startswith(f"fatektool.{schema}/")
    _validator(schema).validate(document)


@cache
def _validator(schema: str) -> Draft202012Validator:
    return Draft202012Validator(json.loads(schema_text(schema)))


class Cli:
    """Runs commands in this process."""

    def __init__(self, capsys: pytest.CaptureFixture[str]) -> None:
        self._capsys = capsys

    def __call__(self, *words: object) -> Done:
        self._capsys.readouterr()
        code = run([str(word) for word in words])
        return Done(code, *self._capsys.readouterr())


class Press:
    """A simulated PLC whose memory lies in a file, and backups beside it."""

    def __init__(self, folder: Path, target: str = "") -> None:
        self.folder = folder
        self.state = folder / "plc.state"
        self.target = target or f"sim:{self.state}"
        build_simulation(ladder_words=400, program=OLD.pages, state=self.state)
        self.old = self.file("old.json", OLD)
        self.new = self.file("new.json", NEW)

    def file(self, name: str, image: Program) -> Path:
        path = self.folder / name
        save_backup(backup(image, target=self.target), path)
        return path

    def set(self, *flags: str) -> None:
        simulation = build_simulation(state=self.state)
        for flag in flags:
            setattr(simulation.plcs[1], flag, True)
        simulation.save_if_changed()

    @property
    def program(self) -> Program:
        return Program(400, tuple(build_simulation(state=self.state).plcs[1].pages))

    @property
    def running(self) -> bool:
        return build_simulation(state=self.state).plcs[1].running

    @property
    def safety(self) -> list[Path]:
        return sorted(self.folder.glob("*.safety-*"))


class Door(NamedTuple):
    """A PLC that is served over TCP by a thread of this process; a client in it waits for no real time."""

    target: str
    simulation: Simulation

    @property
    def pages(self) -> tuple[bytes, ...]:
        return tuple(self.simulation.plcs[1].pages)


@contextmanager
def served(image: Program = OLD, **options: Any) -> Iterator[Door]:
    simulation = build_simulation(ladder_words=image.ladder_words, program=image.pages, **options)
    server = Server(simulation)
    door = server.open_tcp()
    with hurried(server):
        yield Door(door.address, simulation)


def environment(**more: str) -> dict[str, str]:
    """This process's, and more; ``place`` has taken out what would change how a command talks."""
    return dict(os.environ) | {"PYTHONIOENCODING": "utf-8"} | more


def process(*words: object, redirect: str = "", **more: str) -> Done:
    """Run a command as a process; with redirections and pipes behind it, in a shell, as one of its own."""
    if redirect:
        command = ["bash", "-c", f'set -o pipefail; "$@" {redirect}', "bash", *COMMAND, *map(str, words)]
        done = subprocess.run(
            command,
            capture_output=True,
            text=True,
            check=False,
            stdin=subprocess.DEVNULL,
            env=environment(**more),
        )
        return Done(done.returncode, done.stdout, done.stderr)
    with started(*words, env=environment(**more)) as running:
        out, err = running.communicate()
    return Done(running.wait(), out, err)


def started(*words: object, env: dict[str, str] | None = None) -> Process:
    """Start a command as a process."""
    env = env or environment()
    if not CAN_FORK:
        command = [*COMMAND, *map(str, words)]
        null = subprocess.DEVNULL
        return subprocess.Popen(command, stdin=null, stdout=PIPE, stderr=PIPE, text=True, env=env)
    return Forked(words, stdin=subprocess.DEVNULL, stdout=PIPE, stderr=PIPE, environment=env)


def one_line(text: str) -> str:
    """The only line of stderr: no traceback, no second line."""
    (line,) = text.splitlines()
    assert line.startswith("fatektool: ")
    assert "Traceback" not in text
    return line
