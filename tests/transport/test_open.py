"""A target that cannot be opened: one clear line that names it and the next step."""

from __future__ import annotations

import os
import re
import socket
from contextlib import ExitStack
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import LineError, PortBusy, UsageError
from fatektool.transport.base import LineSettings
from fatektool.transport.lock import PortLock
from fatektool.transport.open import open_transport
from fatektool.transport.sockets import resolve
from fatektool.transport.target import Target
from tests.platforms import not_in_wine, posix
from tests.transport.media import LINE, listening, needs_pty
from tests.users import folder_for_all, no_root, not_as_root_alone

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.transport.base import Transport


def opened(target: str, stack: ExitStack, lock_wait_s: float = 0.0) -> Transport:
    return open_transport(Target.parse(target), LINE, stack, lock_wait_s=lock_wait_s)


def refusal(target: str) -> LineError:
    """The error of a target that cannot be opened; nothing stays locked behind it."""
    with ExitStack() as stack, pytest.raises(LineError):
        opened(target, stack)
    with ExitStack() as stack, pytest.raises(LineError) as caught:
        opened(target, stack)
    error = caught.value
    assert error.exit_code == 3
    assert not isinstance(error, PortBusy)
    assert "\n" not in str(error)
    assert error.hint
    return error


def free_port() -> int:
    with socket.socket() as holder:
        holder.bind(("127.0.0.1", 0))
        port: int = holder.getsockname()[1]
        return port


@pytest.mark.parametrize("scheme", ["tcp", "socket", "rfc2217"])
def test_connection_refused(scheme: str) -> None:
    target = f"{scheme}://127.0.0.1:{free_port()}"
    error = refusal(target)
    assert target in error.message
    assert "refused" in error.message


@pytest.mark.parametrize("scheme", ["tcp", "udp"])
@pytest.mark.parametrize("host", ["no-such-host.invalid", "a..b", "x" * 300])
def test_unknown_host(scheme: str, host: str) -> None:
    error = refusal(f"{scheme}://{host}")
    assert error.message.startswith(f"{host}: no such host")
    assert error.details["host"] == host


def test_no_such_port(tmp_path: Path) -> None:
    target = str(tmp_path / "ttyUSB0")
    error = refusal(target)
    assert error.message == f"{target}: no such port"
    assert "fatektool ports" in str(error.hint)


def test_a_plain_file_is_no_port(tmp_path: Path) -> None:
    file = tmp_path / "ttyUSB0"
    file.write_text("mine")
    error = refusal(str(file))
    assert error.message.startswith(f"{file}: cannot be used as a serial port")
    assert file.read_text() == "mine"


def test_a_folder_is_no_port(tmp_path: Path) -> None:
    message = refusal(str(tmp_path)).message
    assert message.startswith(str(tmp_path))
    assert "is a folder, not a serial port" in message or "directory" in message


@posix("on Windows the name is refused: tests/files/test_device_names.py")
def test_a_device_that_is_no_terminal() -> None:
    assert refusal(os.devnull).message.startswith(f"{os.devnull}: cannot be used as a serial port")


@posix("modes of files")
@not_as_root_alone
def test_no_right_to_the_port(monkeypatch: pytest.MonkeyPatch) -> None:
    with folder_for_all() as folder:
        port = folder / "ttyUSB0"
        port.touch(0o600)
        monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(folder))
        assert "cannot be used as a serial port" in refusal(str(port)).message  # all is loaded
        port.chmod(0o000)
        with no_root():
            error = refusal(str(port))
    assert error.message == f"{port}: no permission to use the port"
    assert "dialout" in str(error.hint)


@pytest.mark.parametrize(
    "target",
    [
        "spy:///nowhere",
        "hwgrep://no-such-adapter",
    ],
)
def test_an_url_of_a_port_that_is_not_there(target: str) -> None:
    assert refusal(target).message.startswith(target)


@pytest.mark.parametrize(
    ("target", "words"),
    [
        ("socket://127.0.0.1", "expected socket://HOST:PORT"),
        ("socket://127.0.0.1:99999", "expected socket://HOST:PORT"),
        ("socket://:4001", "expected socket://HOST:PORT"),
        ("socket://", "expected socket://HOST:PORT"),
        ("Rfc2217://", "expected rfc2217://HOST:PORT"),
        ("modem:socket://gateway?number=1", "expected socket://HOST:PORT"),
        ("spy://", "expected spy://PORT"),
        ("alt://?class=Serial", "expected alt://PORT"),
        ("hwgrep://", "expected a text to search for"),
        ("hwgrep://(", "invalid search: "),
        ("hwgrep://x&y=1", "invalid search: unknown option: 'y'"),
        ("loop://?no=such", "invalid options: unknown option or value"),
        ("loop://?logging=all", "invalid options: unknown option or value"),
        ("socket://127.0.0.1:1?logging=all", "invalid options: unknown option or value"),
        ("rfc2217://127.0.0.1:1?x", "invalid options: unknown option: 'x'"),
    ],
)
def test_a_wrong_url_is_no_fault_of_the_line(target: str, words: str) -> None:
    with ExitStack() as stack, pytest.raises(UsageError, match=re.escape(words)) as caught:
        opened(target, stack)
    assert caught.value.hint


def test_a_scheme_that_nobody_knows() -> None:
    with ExitStack() as stack, pytest.raises(UsageError, match="unknown kind of target") as caught:
        opened("tpc://192.168.2.3", stack)
    assert "tcp://" in str(caught.value.hint)


@needs_pty
def test_a_speed_that_the_port_does_not_have() -> None:
    master, slave = os.openpty()
    try:
        name = os.ttyname(slave)
        with ExitStack() as stack:
            transport = open_transport(Target.parse(name), LineSettings(12345, "5S1.5"), stack)
            transport.write(b"x")  # a pty has no speed and no format
            assert os.read(master, 1) == b"x"
    finally:
        os.close(master)
        os.close(slave)


def test_a_simulated_plc_is_no_line() -> None:
    with ExitStack() as stack, pytest.raises(UsageError):
        opened("sim:", stack)


@not_in_wine("its network interfaces have no names")
def test_ipv4_goes_first_and_a_scope_is_kept() -> None:
    assert resolve("localhost", 500) == ("127.0.0.1", 500)
    if not hasattr(socket, "if_nametoindex") or not socket.has_ipv6:
        pytest.skip("no IPv6 scopes here")
    interface = socket.if_nameindex()[0][1]
    assert resolve(f"fe80::1%{interface}", 500)[2:] == (0, socket.if_nametoindex(interface))


# --- locks ------------------------------------------------------------------------------------------


@needs_pty
def test_two_names_of_one_device_are_one_lock(tmp_path: Path) -> None:
    master, slave = os.openpty()
    try:
        name = os.ttyname(slave)
        by_id = tmp_path / "by-id"
        by_id.symlink_to(name)
        with ExitStack() as stack:
            opened(str(by_id), stack)
            with (
                ExitStack() as other,
                pytest.raises(PortBusy, match=f"{name} is in use by process") as caught,
            ):
                opened(name, other)
            assert caught.value.details["holder"] == os.getpid()
        with ExitStack() as stack:
            opened(name, stack)
    finally:
        os.close(master)
        os.close(slave)


@pytest.mark.parametrize("first", ["tcp://localhost", "udp://127.0.0.1", "udp://localhost"])
def test_one_address_is_one_lock(first: str) -> None:
    with listening() as (_, port), ExitStack() as stack:
        opened(f"{first}:{port}", stack)
        with ExitStack() as other, pytest.raises(PortBusy, match="in use by process"):
            opened(f"tcp://127.0.0.1:{port}", other)
        stack.close()
        opened(f"tcp://127.0.0.1:{port}", stack)


def test_the_lock_is_given_back_when_opening_fails() -> None:
    port = free_port()
    with ExitStack() as stack:
        with pytest.raises(LineError, match="refused"):
            opened(f"tcp://127.0.0.1:{port}", stack)
        stack.close()
        lock = PortLock(f"127.0.0.1:{port}", 0)
        lock.acquire()
        lock.release()
