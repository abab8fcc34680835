"""Strangers: pymodbus' own client at the simulated PLC, and this client at pymodbus' own server."""

from __future__ import annotations

import asyncio
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest
from pymodbus import FramerType
from pymodbus.client import ModbusTcpClient
from pymodbus.datastore import ModbusDeviceContext, ModbusSequentialDataBlock, ModbusServerContext
from pymodbus.server import ModbusTcpServer

from fatektool.connection import connect
from fatektool.errors import PlcRefused
from fatektool.jobs.elements.reads import read_elements
from fatektool.jobs.elements.writes import write_elements
from fatektool.protocol.commands import ReadRegisters
from fatektool.protocol.elements import Element
from fatektool.protocol.modbus.map import parse_map
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server, running
from tests.guard import GUARD_S

if TYPE_CHECKING:
    from collections.abc import Iterator

FRAMERS = {
    "modbus-rtu": FramerType.RTU,
    "modbus-ascii": FramerType.ASCII,
    "modbus-tcp": FramerType.SOCKET,
}
each_framing = pytest.mark.parametrize("protocol", FRAMERS)


@each_framing
def test_a_foreign_client(protocol: str) -> None:
    simulation = build_simulation([1, 7], protocol=protocol)
    server = Server(simulation)
    host, _, port = server.open_tcp().address.removeprefix("tcp://").partition(":")
    device = simulation.plcs[7]
    device.write_words("R", 100, [11, 22, 33])
    device.write_discretes("M", 5, b"\1")
    with running(server), ModbusTcpClient(host, port=int(port), framer=FRAMERS[protocol]) as client:
        assert client.read_holding_registers(100, count=3, device_id=7).registers == [11, 22, 33]
        assert client.read_coils(2000, count=10, device_id=7).bits[:10] == [False] * 5 + [True] + [False] * 4
        assert client.read_coils(0, count=256, device_id=7).bits == [False] * 256
        assert not client.write_register(0, 4261, device_id=7).isError()
        assert not client.write_registers(1, list(range(123)), device_id=7).isError()
        assert not client.write_coil(3, value=True, device_id=7).isError()
        assert not client.write_coils(6000, [True, False, True], device_id=7).isError()
        refused = client.read_holding_registers(4168, count=1, device_id=7)
        assert refused.isError()
        assert refused.exception_code == 2
        assert client.read_input_registers(0, count=1, device_id=7).exception_code == 2
        device.write_words("R", 3975, [0, 100, 3])
        assert client.read_input_registers(0, count=3, device_id=7).registers == [99, 100, 101]
        assert client.diag_query_data(b"\x12\x34", device_id=7).exception_code == 1
        assert client.read_holding_registers(0, count=1, device_id=1).registers == [0]
    assert device.read_words("R", 0, 124) == [4261, *range(123)]
    assert device.read_discretes("Y", 3, 1) == b"\1"
    assert device.read_discretes("S", 0, 3) == b"\1\0\1"


@contextmanager
def foreign_server(framer: FramerType) -> Iterator[int]:
    """pymodbus' own server, in a thread; gives its port."""
    block: Any = ModbusSequentialDataBlock  # which has no types
    blocks = {
        "co": block(1, [False] * 10_000),
        "di": block(1, [True, False] * 100),
        "hr": block(1, list(range(10_000))),
        "ir": block(1, [7] * 100),
    }
    loop = asyncio.new_event_loop()
    started = threading.Event()
    found: list[Any] = []

    async def serve() -> None:
        context = ModbusServerContext(devices={3: ModbusDeviceContext(**blocks)}, single=False)
        server = ModbusTcpServer(context, framer=framer, address=("127.0.0.1", 0))
        found.append(server)
        await server.serve_forever(background=True)
        started.set()

    thread = threading.Thread(target=lambda: (loop.run_until_complete(serve()), loop.run_forever()))
    thread.start()
    assert started.wait(GUARD_S)
    try:
        yield found[0].transport.sockets[0].getsockname()[1]
    finally:
        asyncio.run_coroutine_threadsafe(found[0].shutdown(), loop).result(GUARD_S)
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        loop.close()


@each_framing
def test_a_foreign_server(protocol: str) -> None:
    with foreign_server(FRAMERS[protocol]) as port:
        target = f"tcp://127.0.0.1:{port}"
        with connect(target, station=3, protocol=protocol, timeout_s=GUARD_S) as plc:
            wanted = [Element("R", address) for address in range(300)] + [Element("DRC", 200)]
            reading = read_elements(plc, wanted)
            assert not reading.errors
            assert [reading.values[Element("R", address)] for address in range(300)] == list(range(300))
            assert reading.values[Element("DRC", 200)] == 9701 << 16 | 9700
            writes = [
                (Element("R", 5), 99),
                (Element("Y", 3), 1),
                (Element("WM", 8), 0xBEEF),
                (Element("DR", 20), 70000),
            ]
            assert write_elements(plc, writes) == []
            assert plc.read_discretes(Element("M", 8), 16) == tuple(
                0xBEEF >> bit & 1 == 1 for bit in range(16)
            )
            assert plc.link.counters.trouble == 0
        own = parse_map("R0-R3839=400001,M0-M9=100001,R0-R99=300001")
        with connect(target, station=3, protocol=protocol, timeout_s=GUARD_S, modbus_map=own) as plc:
            assert plc.read_discretes(Element("M", 0), 4) == (True, False, True, False)
            assert plc.read_registers(Element("R", 0), 2) == (0, 1)
        inputs = parse_map("R0-R3839=300001,M0-M9=000001")
        with connect(target, station=3, protocol=protocol, timeout_s=GUARD_S, modbus_map=inputs) as plc:
            assert plc.read_registers(Element("R", 0), 2) == (7, 7)
            with pytest.raises(PlcRefused, match="exception 02"):
                plc.link.ask(ReadRegisters(Element("R", 3000), 1))
