"""The least that could work: write a request, read as many bytes as the answer has, again.

It checks nothing. Usage: bare_loop.py TARGET, with ``REQUEST-IN-HEX ANSWER-BYTES`` a line on stdin; prints
``{"duration_s": …}``.
"""

from __future__ import annotations

import json
import os
import socket
import sys
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable


def loop(
    todo: list[tuple[bytes, int]], write: Callable[[bytes], object], read: Callable[[int], bytes]
) -> float:
    """Send all and read all; seconds from the first byte to the last."""
    began = time.perf_counter()
    for request, size in todo:
        write(request)
        missing = size
        while missing:
            missing -= len(read(missing))
    return time.perf_counter() - began


def main() -> None:
    """Run the loop on a TCP or a pty target."""
    target = sys.argv[1]
    lines = (line.split() for line in sys.stdin)
    todo = [(bytes.fromhex(request), int(size)) for request, size in lines]
    if target.startswith("tcp://"):
        host, _, port = target.removeprefix("tcp://").rpartition(":")
        with socket.create_connection((host, int(port))) as connected:
            connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            took = loop(todo, connected.sendall, connected.recv)
    else:
        descriptor = os.open(target, os.O_RDWR | os.O_NOCTTY)
        took = loop(todo, lambda data: os.write(descriptor, data), lambda size: os.read(descriptor, size))
        os.close(descriptor)
    print(json.dumps({"duration_s": took}))


if __name__ == "__main__":
    main()
