"""The examples over SSH, by a real sshd on loopback with a host key, configuration and port of its own."""

from __future__ import annotations

import json
import os
import pwd
import shutil
import socket
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import pytest

from tests.forks.shell import path as shell_path
from tests.root import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

ONE = str(ROOT / "examples" / "ssh" / "status.sh")
MANY = str(ROOT / "examples" / "ssh" / "status_of_many.sh")
PRIVILEGE_SEPARATION = Path("/run/sshd")
NEEDED = [Path("/usr/sbin/sshd")] + [
    Path(shutil.which(name) or f"/nowhere/{name}") for name in ("ssh", "ssh-keygen", "bash")
]

pytestmark = pytest.mark.skipif(
    not all(path.exists() for path in NEEDED), reason="needs sshd (openssh-server), ssh and bash"
)


class Ended(NamedTuple):
    code: int
    out: str
    err: str


class Gateway:
    """This computer as another one, reached by SSH under the name 'gateway'."""

    def __init__(self, folder: Path, port: int) -> None:
        self.folder = folder
        self.port = port

    def run(self, *command: str) -> Ended:
        """Run a script with an ``ssh`` that knows the gateway."""
        path = f"{self.folder / 'bin'}{os.pathsep}{os.environ['PATH']}"
        done = subprocess.run(
            command,
            cwd=self.folder,
            env=os.environ | {"PATH": path},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            check=False,
        )
        return Ended(done.returncode, done.stdout, done.stderr)


def _key(path: Path) -> None:
    subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", str(path)], check=True)


@contextmanager
def _server(folder: Path) -> Iterator[int]:
    """An sshd for each connection of a listening socket (``sshd -i``), so that no port is guessed."""
    config = folder / "sshd_config"
    config.write_text(
        f"HostKey {folder}/host_key\nAuthorizedKeysFile {folder}/user_key.pub\nPidFile none\nUsePAM no\n"
        f"StrictModes no\nPasswordAuthentication no\nKbdInteractiveAuthentication no\nPermitRootLogin yes\n"
        f'SetEnv "PATH={shell_path()}" "FATEKTOOL_LOCK_DIR={folder}"\nLogLevel ERROR\n'
    )
    with socket.create_server(("127.0.0.1", 0)) as listening:
        port = listening.getsockname()[1]
        with subprocess.Popen(
            [sys.executable, "-c", _HAND_ON, "/usr/sbin/sshd", "-i", "-e", "-f", str(config)],
            stdin=listening.fileno(),
            stdout=subprocess.DEVNULL,
            start_new_session=True,
        ) as server:
            try:
                yield port
            finally:
                server.terminate()


_HAND_ON = """
import socket, subprocess, sys
listening = socket.socket(fileno=0)
while True:
    connection, _ = listening.accept()
    subprocess.Popen(sys.argv[1:], stdin=connection, stdout=connection, stderr=subprocess.DEVNULL)
    connection.close()
"""


@pytest.fixture
def gateway(tmp_path: Path) -> Iterator[Gateway]:
    if os.geteuid() == 0:  # what sshd wants there of root, and the system makes at its start
        PRIVILEGE_SEPARATION.mkdir(mode=0o755, exist_ok=True)
    _key(tmp_path / "host_key")
    _key(tmp_path / "user_key")
    host_key = (tmp_path / "host_key.pub").read_text()
    with _server(tmp_path) as port:
        (tmp_path / "known_hosts").write_text(f"[127.0.0.1]:{port} {host_key}")
        user = pwd.getpwuid(os.geteuid()).pw_name
        (tmp_path / "ssh_config").write_text(
            f"Host gateway gateway2\n  HostName 127.0.0.1\n  Port {port}\n  User {user}\n"
            f"  IdentityFile {tmp_path}/user_key\n  IdentitiesOnly yes\n"
            f"  UserKnownHostsFile {tmp_path}/known_hosts\n"
            f"Host gone\n  HostName 127.0.0.1\n  Port 1\n"
        )
        (tmp_path / "bin").mkdir()
        ssh = tmp_path / "bin" / "ssh"
        ssh.write_text(f'#!/bin/sh\nexec {shutil.which("ssh")} -F {tmp_path}/ssh_config "$@"\n')
        ssh.chmod(0o755)
        yield Gateway(tmp_path, port)


def test_the_status_of_one(gateway: Gateway) -> None:
    done = gateway.run(ONE, "gateway", "-p", f"sim:{gateway.folder}/a plc & more.state")
    assert done.code == 0, done
    assert "mode" in done.out
    assert (gateway.folder / "a plc & more.state").exists()  # one word, as it was given
    document = json.loads(gateway.run(ONE, "gateway", "-p", "sim:", "--json").out)
    assert document["schema"] == "fatektool.status/1"


def test_the_exit_code_is_fatektools(gateway: Gateway) -> None:
    done = gateway.run(ONE, "gateway", "-p", "/dev/ttyNOTHERE")
    assert done.code == 3
    assert "no such port" in done.err
    assert gateway.run(ONE, "gateway", "--nope").code == 2


def test_a_host_that_is_not_reached(gateway: Gateway) -> None:
    done = gateway.run(ONE, "gone", "-p", "sim:")
    assert done.code == 255
    assert "ssh:" in done.err
    done = gateway.run(ONE)
    assert done.code != 0
    assert "usage: status.sh HOST" in done.err


def test_the_status_of_many(gateway: Gateway) -> None:
    hosts = gateway.folder / "hosts.txt"
    hosts.write_text("# the hall\ngateway -p sim: --brief\n\ngateway2 -p 'sim:' --station 7 --brief\n")
    done = gateway.run(MANY, str(hosts))
    assert done.code == 0, done
    lines = done.out.splitlines()
    assert lines[-1] == "2 of 2 answered"
    plcs = [line for line in lines if ": PLC" in line]
    assert [line.split()[0] for line in plcs] == ["gateway:", "gateway2:"]
    assert plcs[0].endswith("station 1 on sim:")
    assert plcs[1].endswith("station 7 on sim:")


def test_many_of_which_some_do_not_answer(gateway: Gateway) -> None:
    hosts = gateway.folder / "hosts.txt"
    hosts.write_text("gateway -p sim:\ngone -p sim:\ngateway2 -p /dev/ttyNOTHERE\n" + "gateway -p sim:\n" * 9)
    done = gateway.run(MANY, str(hosts))
    assert done.code == 1
    assert done.out.splitlines()[-1] == "10 of 12 answered"
    assert "gone: no status, exit code 255" in done.err
    assert "gateway2: no status, exit code 3" in done.err


def test_no_hosts(gateway: Gateway) -> None:
    (gateway.folder / "hosts.txt").write_text("# none\n")
    done = gateway.run(MANY, "hosts.txt")
    assert done.code == 2
    assert "expected a host in each line" in done.err
