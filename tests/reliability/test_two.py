"""Two at once, and holders that die, stop or are somebody else: no jam, and no answer in the wrong hands."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.connection import connect
from fatektool.errors import LineError
from fatektool.protocol.elements import Element
from fatektool.simulator.build import build_simulation
from fatektool.simulator.faults import SpoiledAnswer
from fatektool.simulator.listen.pty import PTY_SUPPORTED
from fatektool.simulator.listen.servers import Server, running
from tests.cli.running import one_line, process, started
from tests.guard import GUARD_S
from tests.users import NOBODY, two_users

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.simulator.build import Simulation
    from fatektool.simulator.slaves.base import RequestFrame, Slave

pytestmark = pytest.mark.skipif(not PTY_SUPPORTED, reason="needs ptys and POSIX locks")

REGISTERS = 1000
CLIENT = Path(__file__).with_name("turns.py")


def value(address: int) -> int:
    """What stands in a register: no two of them hold the same."""
    return (address * 31 + 7) % 65536


@contextmanager
def line(link: Path, **options: Any) -> Iterator[tuple[str, Simulation]]:
    """A PLC on a pty: one line, whoever opens it."""
    simulation = build_simulation(ladder_words=64, **options)
    simulation.plcs[1].write_words("R", 0, [value(address) for address in range(REGISTERS)])
    server = Server(simulation)
    door = server.open_pty(link)
    with running(server):
        yield door.address, simulation


def taking_turns(target: str, exchanges: int, locks: tuple[Path, Path]) -> list[dict[str, int]]:
    """Two processes, each of which opens the line, asks for a while, closes it, and opens it again."""
    clients = [
        subprocess.Popen(
            [sys.executable, str(CLIENT), target, str(exchanges), str(seed)],
            stdout=subprocess.PIPE,
            text=True,
            env=dict(os.environ) | {"FATEKTOOL_LOCK_DIR": str(folder)},
        )
        for seed, folder in enumerate(locks, 1)
    ]
    told = []
    for client in clients:
        with client:
            assert client.stdout is not None
            told.append(json.loads(client.stdout.read()))
        assert client.returncode == 0
    return told


@pytest.mark.parametrize(
    "exchanges",
    [
        1_200,
        pytest.param(80_000, marks=pytest.mark.slow, id="an hour at 9600 baud"),
    ],
)
def test_two_processes_on_one_line_never_get_each_others_answers(tmp_path: Path, exchanges: int) -> None:
    with line(tmp_path / "plc") as (target, _):
        locks = tmp_path / "locks"
        for client in taking_turns(target, exchanges, (locks, locks)):
            assert client["exchanges"] >= exchanges
            assert client["turns"] > 20
            assert client["wrong"] == 0
            assert client["trouble"] == 0


def test_a_program_with_another_idea_of_locks_is_kept_out_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two folders for locks are no lock: then the port itself is opened for one process only."""
    other = tmp_path / "other"
    other.mkdir()
    with line(tmp_path / "plc") as (target, _), connect(target):
        monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(other))
        done = process("read", "R0", "-p", target)
        assert done.code == 3
        assert "another program has the port open; close that program" in one_line(done.err)


def test_a_restore_and_a_backup_at_once_wait_for_each_other(tmp_path: Path, place: Path) -> None:
    """The backup holds the old program or the new one, never a half of each."""
    with line(tmp_path / "plc") as (target, simulation):
        old = list(simulation.plcs[1].pages)
        wanted = build_simulation(ladder_words=64, program_seed=5, state=place / "wanted.state").plcs[1]
        assert process("backup", "new.json", "-p", f"sim:{place / 'wanted.state'}").code == 0
        both = [
            started("restore", "new.json", "--yes", "-p", target),
            started("backup", "x.json", "-p", target),
        ]
        for command in both:
            _, err = command.communicate()
            assert command.returncode == 0, err
        assert simulation.plcs[1].pages == wanted.pages
        pages = [bytes.fromhex(page) for page in json.loads((place / "x.json").read_bytes())["pages"]]
        assert pages in (old, wanted.pages)


# --- the holder dies ------------------------------------------------------------------------------------


def killed_with_an_answer_on_its_way(target: str) -> None:
    """A process asks for R5 and is killed before the PLC, which is slow, has answered."""
    script = (
        "import os, signal, sys; from fatektool.connection import connect\n"
        "from fatektool.protocol.elements import Element\n"
        "plc = connect(sys.argv[1], timeout_s=600)\n"
        "send = plc.link.transport.write\n"
        "def write(data):\n    send(data)\n    os.kill(os.getpid(), signal.SIGKILL)\n"
        "plc.link.transport.write = write\n"
        "plc.read_registers(Element.parse('R5'), 1)"
    )
    done = subprocess.run([sys.executable, "-c", script, target], check=False)
    assert done.returncode == -signal.SIGKILL


def impatient(target: str) -> None:
    """A command that does not wait for the answer, and says so."""
    done = process("read", "R5", "-p", target, "--timeout", 0.02, "--retries", 0)
    assert done.code == 3
    assert "no answer" in one_line(done.err)


@contextmanager
def one_answer_held_back(link: Path) -> Iterator[str]:
    """A PLC that is slow once: its first answer comes right before the next one."""
    with line(link, faults=["late=1"]) as (target, simulation):
        faults = simulation.faults
        assert faults is not None
        spoil = faults.spoil
        struck = False

        def once(slave: Slave, request: RequestFrame, answer: bytes) -> SpoiledAnswer:
            nonlocal struck
            spoiled = SpoiledAnswer([answer]) if struck else spoil(slave, request, answer)
            struck = True
            return spoiled

        faults.spoil = once  # type: ignore[method-assign]  # a fault that strikes once
        yield target


@pytest.mark.parametrize("leave", [killed_with_an_answer_on_its_way, impatient])
def test_the_answer_to_one_that_is_gone_is_not_taken_by_the_next(tmp_path: Path, leave: Any) -> None:
    """The lock is free at once, and the PLC still at work on the question before: it puts up a fence."""
    with one_answer_held_back(tmp_path / "plc") as target:
        leave(target)
        with connect(target, timeout_s=GUARD_S, lock_wait_s=0) as plc:
            assert plc.read_registers(Element.parse("R9"), 1) == (value(9),)
            assert plc.link.counters.fences == 1
            assert plc.link.counters.strays == 1
        with connect(target, timeout_s=GUARD_S, lock_wait_s=0) as plc:
            assert plc.read_registers(Element.parse("R9"), 1) == (value(9),)
            assert plc.link.counters.fences == 0, "a good end leaves no doubt"


def test_a_doubt_is_handed_on_once(tmp_path: Path) -> None:
    """A PLC that answers no fence must not lock everybody out for ever."""
    with line(tmp_path / "plc", faults=["drop=1"]) as (target, _):
        impatient(target)
        found = []
        for _ in range(2):
            with connect(target, timeout_s=0.01, retries=0) as plc:
                found.append(plc.link.receiver.needs_fence)
                with pytest.raises(LineError):
                    plc.read_registers(Element.parse("R9"), 1)  # no fence comes down
        assert found == [True, False]


def test_a_holder_that_was_killed_holds_up_nobody(tmp_path: Path) -> None:
    with line(tmp_path / "plc") as (target, _), started("watch", "R0", "-p", target) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline()
        assert process("read", "R0", "-p", target, "--lock-wait", 0).code == 3
        holder.kill()
        holder.wait()
        done = process("read", "R9", "-p", target, "--lock-wait", 0)
        assert (done.code, done.out.split()) == (0, ["R9", str(value(9))])


def test_a_holder_that_stands_still_is_named(tmp_path: Path) -> None:
    """Stopped by a debugger, or a machine that hangs: who waits is told whom to look at."""
    with line(tmp_path / "plc") as (target, _), started("watch", "R0", "-p", target) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline()
        os.kill(holder.pid, signal.SIGSTOP)
        try:
            done = process("read", "R0", "-p", target, "--lock-wait", 0.1, "--json")
            assert done.code == 3
            error = done.document("error")["error"]
            assert error["kind"] == "port_busy"
            assert error["details"]["holder"] == holder.pid
            at_once, at_last = done.err.splitlines()
            assert f"is in use by process {holder.pid} (fatektool watch R0 -p " in at_once
            assert at_once.endswith("Z): waiting, for 0.1 s at most")
            assert "Z): waited 0.1 s; wait until it has ended or stop process" in at_last
            assert error["details"]["command"].startswith("fatektool watch R0 -p ")
            assert "--lock-wait" in error["hint"]
        finally:
            holder.kill()
        holder.wait()
        assert process("read", "R0", "-p", target, "--lock-wait", 0).code == 0


# --- another user -----------------------------------------------------------------------------------------

TRY = """
import os, pathlib, sys  # all that is loaded later: another user may not read this Python
from fatektool.errors import FatektoolError
from fatektool.transport.lock import PortLock
os.setgroups([]); os.setgid({user}); os.setuid({user})
lock = PortLock("/dev/ttyUSB0", 0)
try:
    lock.acquire()
except FatektoolError as error:
    print(type(error).__name__, str(error))
else:
    print("locked")
    sys.stdout.flush()
    if sys.argv[1:] == ["hold"]:
        sys.stdin.readline()
"""


@pytest.fixture
def shared(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder in which every user makes files and nobody removes another's, as /run/lock is."""
    with tempfile.TemporaryDirectory() as name:
        Path(name).chmod(0o1777)
        monkeypatch.setenv("FATEKTOOL_LOCK_DIR", name)
        yield Path(name)


def as_user(user: int, *words: str, script: str = TRY) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", script.format(user=user), *words],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )


def tried(user: int) -> str:
    with as_user(user) as other:
        return other.communicate()[0].strip()


@two_users
@pytest.mark.parametrize("users", [(0, NOBODY), (NOBODY, 0), (1, NOBODY)])
def test_a_lock_file_that_another_user_left_is_nobodys(shared: Path, users: tuple[int, int]) -> None:
    first, second = users
    mask = os.umask(0o077)  # the mode of the file must not be the umask's
    try:
        assert tried(first) == "locked"
    finally:
        os.umask(mask)
    (file,) = shared.iterdir()
    assert (file.stat().st_uid, file.stat().st_mode & 0o777) == (first, 0o666)
    assert tried(second) == "locked"


@two_users
@pytest.mark.parametrize("users", [(0, NOBODY), (NOBODY, 0)])
@pytest.mark.parametrize("mode", [0o644, 0o444])
def test_a_lock_file_of_another_user_that_may_only_be_read(
    users: tuple[int, int], mode: int, shared: Path
) -> None:
    """Held, it is respected; left behind, it stops nobody."""
    owner, other = users
    assert tried(owner) == "locked"
    (file,) = shared.iterdir()
    file.chmod(mode)
    with as_user(owner, "hold") as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "locked\n"
        assert tried(other).startswith("PortBusy /dev/ttyUSB0 is in use by")
        holder.kill()
    assert tried(other) == "locked"


@two_users
@pytest.mark.parametrize("users", [(0, NOBODY), (NOBODY, 0)])
def test_a_lock_folder_of_root_alone_is_no_place_for_root_either(
    users: tuple[int, int], shared: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (shared / "run").mkdir(0o755)
    (shared / "all").mkdir()
    (shared / "all").chmod(0o1777)
    monkeypatch.delenv("FATEKTOOL_LOCK_DIR")
    places = f"from fatektool.transport import lock; lock._SHARED = ['{shared}/run', '{shared}/all']\n"
    first, second = users
    with as_user(first, "hold", script=places + TRY) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "locked\n"
        with as_user(second, script=places + TRY) as other:
            assert other.communicate()[0].startswith("PortBusy /dev/ttyUSB0 is in use by process")
        holder.kill()


@two_users
def test_a_lock_file_of_another_user_that_may_not_even_be_read(shared: Path) -> None:
    """No lock file of fatektool is like that. It is said which file, and what to do."""
    assert tried(0) == "locked"
    (file,) = shared.iterdir()
    file.chmod(0o600)
    said = tried(NOBODY)
    assert said.startswith(f"UsageError cannot create the lock file {file}: Permission denied")
    assert "FATEKTOOL_LOCK_DIR" in said


@two_users
def test_a_process_killed_while_it_makes_the_file_keeps_no_other_user_out(shared: Path) -> None:
    """The file is for all users from the moment that it has its name."""
    die = TRY.replace("lock.acquire()", "os.fchmod = lambda *_: os.kill(os.getpid(), 9)\n    lock.acquire()")
    mask = os.umask(0o077)
    try:
        done = subprocess.run([sys.executable, "-c", die.format(user=1)], check=False)
    finally:
        os.umask(mask)
    assert done.returncode == -signal.SIGKILL
    assert len(list(shared.iterdir())) == 1, "it was killed too early or too late"
    assert tried(NOBODY) == "locked"
