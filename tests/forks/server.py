"""A process that has loaded the program and makes a child for each command line that it is given.

It listens at a socket in the file system. On a connection come the length of an order with descriptors beside
it, then the order, by ``marshal``::

    (words, folder, environment, numbers of the descriptors, takes a terminal, limits)

Back go the child's process id and, at its end, its exit code as ``subprocess`` has it, four bytes each. The
child runs ``python -m fatektool`` to its end, and ends as Python does. The server ends when its standard
input does.
"""

from __future__ import annotations

import atexit
import contextlib
import fcntl
import gc
import importlib
import io
import marshal
import os
import pkgutil
import resource
import runpy
import select
import socket
import sys
import termios
import threading
from typing import BinaryIO, NamedTuple, cast

import fatektool
from fatektool.simulator.build import build_plcs

_OTHERS = ("rich.console", "rich.progress", "rich.table", "rich.live", "serial", "serial.tools.list_ports")
_STREAMS = (("stdin", "r"), ("stdout", "w"), ("stderr", "w"))
_MOST = 64
_FREE = 200
"""From here on the child has no descriptors that it was given."""


class Order(NamedTuple):
    """What a child is to be."""

    words: list[str]
    folder: str
    environment: dict[bytes, bytes]
    numbers: list[int]
    takes_terminal: bool
    limits: dict[str, int]


def load_all() -> None:
    """Load what any command may load, so that no child has to."""
    for module in pkgutil.walk_packages(fatektool.__path__, "fatektool."):
        if not module.name.endswith("__main__"):
            importlib.import_module(module.name)
    for name in _OTHERS:
        importlib.import_module(name)
    build_plcs()  # and make the program of a simulated PLC
    gc.collect()
    gc.freeze()


def order_on(line: socket.socket) -> tuple[Order, list[int]]:
    """The order of a connection, and its descriptors."""
    head, descriptors, _, _ = socket.recv_fds(line, 4, _MOST)
    size, data = int.from_bytes(head, "big"), b""
    while len(data) < size:
        data += line.recv(size - len(data))
    return Order(*marshal.loads(data)), descriptors  # noqa: S302  # of our own


def place(numbers: list[int], descriptors: list[int]) -> None:
    """Give descriptors the numbers that they are to have, and close what else there is."""
    high = [fcntl.fcntl(descriptor, fcntl.F_DUPFD, _FREE) for descriptor in descriptors]
    os.closerange(0, _FREE)
    for number, descriptor in zip(numbers, high, strict=True):
        os.dup2(descriptor, number)
    os.closerange(_FREE, high[-1] + 1 if high else _FREE)


def make_streams(numbers: list[int]) -> None:
    """Standard streams as Python makes them when it starts."""
    encoding, _, errors = os.environ.get("PYTHONIOENCODING", "").partition(":")
    unbuffered = bool(os.environ.get("PYTHONUNBUFFERED"))
    for number, (name, mode) in enumerate(_STREAMS):
        stream = None
        if number in numbers:
            raw = open(number, f"{mode}b", 0 if unbuffered and number else -1, closefd=False)  # noqa: SIM115
            stream = io.TextIOWrapper(
                cast("BinaryIO", raw),
                encoding or "utf-8",
                "backslashreplace" if number == 2 else errors or "strict",
                line_buffering=number == 2 or raw.isatty(),
                write_through=unbuffered,
            )
        setattr(sys, name, stream)
        setattr(sys, f"__{name}__", stream)


def be(order: Order, descriptors: list[int]) -> None:
    """Be the child."""
    place(order.numbers, descriptors)
    if order.takes_terminal:
        os.setsid()
        fcntl.ioctl(2, termios.TIOCSCTTY, 0)
    os.chdir(order.folder)
    os.environb.clear()
    os.environb.update(order.environment)
    for name, most in order.limits.items():
        resource.setrlimit(getattr(resource, name), (most, most))
    make_streams(order.numbers)
    sys.argv = ["fatektool", *order.words]
    try:
        runpy.run_module("fatektool", run_name="__main__", alter_sys=True)
    except SystemExit as end:
        leave(end.code if isinstance(end.code, int) else 1)


def leave(code: int) -> None:
    """End as Python does, but for taking hundreds of modules apart, which takes longer than most commands."""
    threading._shutdown()  # type: ignore[attr-defined]
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        try:
            if stream is not None:
                stream.flush()
        except OSError:
            code = 120
    os._exit(code)


def keep(line: socket.socket) -> None:
    """Make the child of this connection, and tell of it; returns in a child that failed."""
    order, descriptors = order_on(line)
    child = os.fork()
    if not child:
        be(order, descriptors)
        return
    for descriptor in descriptors:
        os.close(descriptor)
    line.sendall(child.to_bytes(4, "big"))
    _, status = os.waitpid(child, 0)
    line.sendall(os.waitstatus_to_exitcode(status).to_bytes(4, "big", signed=True))
    os._exit(0)


def serve(path: str) -> None:
    """Make children until standard input ends."""
    listening = socket.socket(socket.AF_UNIX)
    listening.bind(f"{path}.new")
    listening.listen(64)
    os.rename(f"{path}.new", path)  # noqa: PTH104  # one that does not listen yet refuses
    load_all()
    poll = select.poll()
    for each in (listening.fileno(), 0):
        poll.register(each, select.POLLIN)
    while (listening.fileno(), select.POLLIN) in poll.poll():
        line = listening.accept()[0]
        if not os.fork():
            keep(line)
            return
        line.close()
        with contextlib.suppress(ChildProcessError):  # there is none
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass


if __name__ == "__main__":
    serve(sys.argv[1])
