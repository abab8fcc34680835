"""Your own FATEK client against the simulator: a real socket, a PLC with memory, and a bad line.

Run with: pytest test_my_client.py
"""

from __future__ import annotations

import socket

from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server, running


def read_r0(address: tuple[str, int]) -> int | None:
    """The client under test: R0 by command 46, None for no answer."""
    with socket.create_connection(address) as connection:
        connection.settimeout(0.2)
        connection.sendall(b"\x02014601R0000070\x03")
        try:
            answer = connection.recv(100)
        except TimeoutError:
            return None
    return int(answer[6:10], 16)


def address_of(server: Server) -> tuple[str, int]:
    """A new TCP port of the simulator."""
    host, _, port = server.open_tcp().address.removeprefix("tcp://").rpartition(":")
    return host, int(port)


def test_reads_a_register() -> None:
    """What the PLC holds is what the client reads."""
    simulation = build_simulation()
    simulation.plcs[1].write_words("R", 0, [4711])
    server = Server(simulation)
    address = address_of(server)
    with running(server):
        assert read_r0(address) == 4711


def test_survives_a_plc_that_does_not_answer() -> None:
    """A lost answer is no crash."""
    server = Server(build_simulation(faults=["drop=1"]))
    address = address_of(server)
    with running(server):
        assert read_r0(address) is None
