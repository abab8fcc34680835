"""Your own FATEK client against the simulator: a real socket, a PLC with memory, and a bad line.

Run with: pytest test_my_client.py
"""

from __future__ import annotations

import socket

import fatektool


def read_r0(host: str, port: int) -> int | None:
    """The client under test: R0 by command 46, None for no answer."""
    with socket.create_connection((host, port)) as connection:
        connection.settimeout(0.2)
        connection.sendall(b"\x02014601R0000070\x03")
        try:
            answer = connection.recv(100)
        except TimeoutError:
            return None
    return int(answer[6:10], 16)


def test_reads_a_register() -> None:
    """What the PLC holds is what the client reads."""
    with fatektool.simulate() as simulated:
        simulated.plcs[1].write_words("R", 0, [4711])
        assert read_r0(simulated.host, simulated.port) == 4711


def test_survives_a_plc_that_does_not_answer() -> None:
    """A lost answer is no crash."""
    with fatektool.simulate(faults=["drop=1"]) as simulated:
        assert read_r0(simulated.host, simulated.port) is None
