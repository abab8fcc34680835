"""Which PLCs share a line: they are asked one after the other, all others side by side."""

from __future__ import annotations

import ipaddress
import os
import threading
from typing import TYPE_CHECKING, Final

from fatektool.errors import LineError
from fatektool.transport.serial_line.url import host_of
from fatektool.transport.serial_line.url import line_name as serial_line_name
from fatektool.transport.target import Target, TargetKind

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.address import PlcAddress


_LOOK_UP_S: Final = 5.0


def line_name(address: PlcAddress, name: str, addresses: dict[str, str]) -> str:
    """What a PLC's line is called: the same for two PLCs that must not be asked at once.

    Args:
        address: the PLC's.
        name: the PLC's; a new simulated PLC has a line of its own.
        addresses: hosts and their addresses, of ``addresses_of``.
    """
    where = address.where
    if where.kind is TargetKind.SIM:
        return f"sim:{os.path.realpath(where.path)}" if where.path else f"sim:{name}"
    gateway = _host(where)
    if gateway is not None:
        return f"{addresses.get(gateway[0], gateway[0])}:{gateway[1]}"
    return serial_line_name(where.path)


def addresses_of(targets: Iterable[str], wait_s: float = _LOOK_UP_S) -> dict[str, str]:
    """The addresses of all hosts that are named by words: two names may be one gateway.

    All are looked up at once. One that is not found in time is left out, and its name is used then.
    """
    gateways = filter(None, (_host(_parsed(target)) for target in targets))
    hosts = {host for host, _ in gateways if not _is_address(host)}
    found: dict[str, str] = {}

    def look_up(host: str) -> None:
        from fatektool.transport.sockets import resolve

        try:
            found[host] = resolve(host, 1)[0]
        except LineError:  # said again, with the PLC's name, when it is asked
            return

    threads = [threading.Thread(target=look_up, args=(host,), daemon=True) for host in sorted(hosts)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(wait_s)
        wait_s = 0.0 if thread.is_alive() else wait_s
    return dict(found)


def _parsed(target: str) -> Target:
    return Target.parse(target, default_port=1)


def _host(where: Target) -> tuple[str, int] | None:
    """Host and port that a target leads to; None for one that leads to none, or is wrong."""
    if where.kind in {TargetKind.TCP, TargetKind.UDP}:
        return where.host.lower(), where.port
    try:
        return host_of(where.path) if where.on_serial_port else None
    except LineError:  # said again, with the PLC's name, when it is asked
        return None


def _is_address(host: str) -> bool:
    try:
        ipaddress.ip_address(host.partition("%")[0])
    except ValueError:
        return False
    return True
