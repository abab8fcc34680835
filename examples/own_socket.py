"""Ask a PLC over a socket of your own, with fatektool for the frames alone.

    python examples/own_socket.py 127.0.0.1 500 R0 3

Prints the registers. For a program that has its own line to the PLC; ``fatektool.connect`` is the easier way,
and has deadlines, retries and fences that this has not. Try it on ``fatektool simulate --tcp 127.0.0.1:500``.
"""

from __future__ import annotations

import socket
import sys

import fatektool

STATION = 1
ETX = b"\x03"


def ask(line: socket.socket, first: str, count: str) -> list[int]:
    """Registers, by one request and one answer."""
    request = fatektool.parse_command("46", first, count).request
    line.sendall(fatektool.frame(request, STATION))
    answer = b""
    while not answer.endswith(ETX):  # an answer may come in pieces
        piece = line.recv(512)
        if not piece:
            raise SystemExit("the PLC closed the connection")
        answer += piece
    if answer[-3:-1] != fatektool.checksum(answer[:-3]):
        raise SystemExit(f"a damaged answer: {answer!r}")
    error = int(answer[5:6], 16)
    if error:
        raise SystemExit(f"the PLC refused: {fatektool.error_text(error)}")
    digits = answer[6:-3]
    return [int(digits[at : at + 4], 16) for at in range(0, len(digits), 4)]


def main(host: str, port: str, first: str, count: str) -> None:
    """Ask and print."""
    with socket.create_connection((host, int(port)), timeout=5) as line:
        print(*ask(line, first, count))


if __name__ == "__main__":
    if len(sys.argv) != 5:
        raise SystemExit(f"usage: {sys.argv[0]} HOST PORT ELEMENT COUNT")
    main(*sys.argv[1:])
