"""A process that has loaded the program and makes a child for each command line; see ``forked``.

On its standard input, a socket, come orders: a line of JSON, with four descriptors beside its first byte::

    {"words": ["status", ...], "folder": "/tmp/..", "environment": {...}, "closed": [0], "terminal": false,
     "limits": {"RLIMIT_FSIZE": 8192}}

The descriptors are the child's standard input, output and error, and a pipe that takes two lines: the child's
process id, and its exit code as ``subprocess`` has it. The child runs ``python -m fatektool`` to its end, and
ends as Python does.
"""

from __future__ import annotations

import atexit
import fcntl
import gc
import importlib
import io
import json
import os
import pkgutil
import resource
import runpy
import signal
import socket
import sys
import termios
import threading
from typing import Any, BinaryIO, cast

import fatektool

_OTHERS = ("rich.console", "rich.progress", "rich.table", "rich.live", "serial", "serial.tools.list_ports")
_STREAMS = (("stdin", "r"), ("stdout", "w"), ("stderr", "w"))


def load_all() -> None:
    """Load what any command may load, so that no child has to."""
    for module in pkgutil.walk_packages(fatektool.__path__, "fatektool."):
        if not module.name.endswith("__main__"):
            importlib.import_module(module.name)
    for name in (
        "rich.console",
        "rich.progress",
        "rich.table",
        "rich.live",
        "serial",
        "serial.tools.list_ports",
    ):
        importlib.import_module(name)
    gc.collect()
    gc.freeze()


def next_order(orders: socket.socket) -> tuple[dict[str, Any], list[int]] | None:
    """The next order and its descriptors; None at the end."""
    data, descriptors, _, _ = socket.recv_fds(orders, 1, 4)
    if not data:
        return None
    while not data.endswith(b"\n"):
        data += orders.recv(65536)
    return json.loads(data), descriptors


def make_streams(closed: list[int]) -> None:
    """Standard streams as Python makes them when it starts."""
    encoding, _, errors = os.environ.get("PYTHONIOENCODING", "").partition(":")
    unbuffered = bool(os.environ.get("PYTHONUNBUFFERED"))
    for number, (name, mode) in enumerate(_STREAMS):
        stream = None
        if number in closed:
            os.close(number)
        else:
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


def be(order: dict[str, Any], descriptors: list[int]) -> None:
    """Be the child."""
    for number, descriptor in enumerate(descriptors[:3]):
        os.dup2(descriptor, number)
    for descriptor in descriptors:
        os.close(descriptor)
    if order["terminal"]:
        os.setsid()
        fcntl.ioctl(2, termios.TIOCSCTTY, 0)
    os.chdir(order["folder"])
    os.environ.clear()
    os.environ.update(order["environment"])
    for name, most in order["limits"].items():
        resource.setrlimit(getattr(resource, name), (most, most))
    make_streams(order["closed"])
    sys.argv = ["fatektool", *order["words"]]
    try:
        runpy.run_module("fatektool", run_name="__main__", alter_sys=True)
    except SystemExit as end:
        leave(end.code if isinstance(end.code, int) else 1)


def leave(code: int) -> None:
    """End as Python does, but for taking a hundred modules apart, which takes longer than most commands."""
    threading._shutdown()  # type: ignore[attr-defined]
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        try:
            if stream is not None:
                stream.flush()
        except OSError:
            code = 120
    os._exit(code)


def keep(descriptors: list[int]) -> bool:
    """Make the child and tell of it; True in the child."""
    child = os.fork()
    if not child:
        return True
    told = descriptors[3]
    for descriptor in descriptors[:3]:
        os.close(descriptor)
    os.write(told, b"%d\n" % child)
    _, status = os.waitpid(child, 0)
    os.write(told, b"%d\n" % os.waitstatus_to_exitcode(status))
    return False


def serve() -> None:
    """Take orders to the end; returns in no child before it has run."""
    load_all()
    orders = socket.socket(fileno=os.dup(0))
    while (order := next_order(orders)) is not None:
        if os.fork() == 0:
            orders.close()
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            if keep(order[1]):
                be(*order)
                return
            os._exit(0)
        for descriptor in order[1]:
            os.close(descriptor)


if __name__ == "__main__":
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # the system takes those who have told
    serve()
