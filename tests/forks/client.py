"""The command ``fatektool`` for a shell: hands what it was given to the server, and ends as its child does.

It imports nothing that Python has not loaded already, as that would take longer than all the rest.
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]  # signal loads enum
import _socket
import marshal
import posix
import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

_MOST = 64
_INTS = 4
SOCKET = ""
"""Where the server listens; ``shell`` writes it here."""


def ask(order: Any, descriptors: list[int]) -> tuple[_socket.socket, int]:
    """Have a child made; the line on which its exit code comes, and its process id."""
    line = _socket.socket(_socket.AF_UNIX, _socket.SOCK_STREAM)
    line.connect(SOCKET)
    data = marshal.dumps(order)
    passed = b"".join(number.to_bytes(_INTS, sys.byteorder) for number in descriptors)
    head = len(data).to_bytes(_INTS, "big")
    line.sendmsg([head], [(_socket.SOL_SOCKET, _socket.SCM_RIGHTS, passed)])
    line.sendall(data)
    return line, told(line)


def told(line: _socket.socket) -> int:
    """What the server tells next. That it is gone is no 0, which would be every process if it were killed."""
    data = line.recv(_INTS)
    if len(data) != _INTS:
        raise RuntimeError("the server of forks is gone")
    return int.from_bytes(data, "big", signed=True)


def main() -> None:
    listed = [int(name) for name in posix.listdir("/proc/self/fd")]
    numbers = [number for number in listed if _is_open(number)][:_MOST]
    words = sys.argv[1:]
    line, child = ask((words, posix.getcwd(), posix.environ, numbers, False, {}), numbers)
    for number in (_signal.SIGINT, _signal.SIGTERM):
        if _signal.getsignal(number) != _signal.SIG_IGN:  # as a shell leaves it in the background
            _signal.signal(number, lambda number, _: posix.kill(child, number))
    code = told(line)
    if code < 0:
        _signal.signal(-code, _signal.SIG_DFL)
        posix.kill(posix.getpid(), -code)
    posix._exit(code)


def _is_open(number: int) -> bool:
    try:
        posix.fstat(number)
    except OSError:  # the one that listed them
        return False
    return True


if __name__ == "__main__":
    main()
