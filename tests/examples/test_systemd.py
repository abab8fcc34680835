"""The units, started by systemd itself, with the user and the folders that examples/README.md makes."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from tests.examples.conftest import EXAMPLES, NODE_EXPORTER

if TYPE_CHECKING:
    from tests.examples.conftest import Blocks, Gateway


AGAIN = """
systemctl start fatektool-snapshot.service
systemctl start fatektool-fleet.service
systemctl start --no-block fatektool-fleet.service
systemctl start fatektool-snapshot.service fatektool-fleet.service
systemctl list-timers --no-pager --no-legend --all > /out/timers
systemctl --failed --no-legend > /out/failed
cd /var/lib/fatektool
ls backups press > /out/kept
stat -c '%U %a %n' . backups history press backups/* press/* > /out/rights
stat -c '%U %a' /var/lib/prometheus/node-exporter/fatek-backup.prom > /out/prom
sudo -u nobody cat /var/lib/prometheus/node-exporter/fatek-backup.prom >> /out/prom
"""
ONE_GONE = """
systemctl start fatektool-fleet.service || systemctl show -p Result -p ExecMainStatus fatektool-fleet.service
"""


def test_by_systemd(gateway: Gateway, blocks: Blocks) -> None:
    ended = gateway.run(
        NODE_EXPORTER,
        blocks.user_by_systemd,
        blocks.inventory,
        gateway.inventory(),
        blocks.systemd,
        AGAIN,
        gateway.inventory("[plc.gone]\ntarget = 'tcp://127.0.0.1:1'\n"),
        ONE_GONE,
    )
    assert ended.code == 0, ended
    left = ended.left
    assert (left / "failed").read_text() == ""
    timers = (left / "timers").read_text()
    for name in ("fleet", "snapshot"):
        assert re.search(
            rf"^\w{{3}} .* fatektool-{name}\.timer +fatektool-{name}\.service$", timers, re.MULTILINE
        )
    kept = (left / "kept").read_text().split()
    assert {"press.json", "oven.json"} <= set(kept)
    assert sum(name.startswith("snapshot-st01-") for name in kept) >= 2
    rights = [line.split() for line in (left / "rights").read_text().splitlines()]
    assert {user for user, _, _ in rights} == {"fatektool"}
    assert {mode for _, mode, name in rights if name.endswith(".json")} == {"640"}
    prom = (left / "prom").read_text()
    assert prom.startswith("fatektool 644\n")  # and another user's collector has read it:
    assert 'fatek_exit_code{job="backup",plc="oven"} 0' in prom
    assert "Result=exit-code\nExecMainStatus=1" in ended.out


LOCKS = """
systemctl start fatektool-snapshot.service
ls /run/lock/fatektool-*.lock > /out/in-run
rm /run/lock/fatektool-*.lock
chmod 0755 /run/lock
systemctl start fatektool-snapshot.service
ls /tmp/fatektool-*.lock > /out/in-tmp
sudo -u fatektool fatektool status -p /dev/ttyUSB0 -q > /dev/null
ls /tmp/fatektool-*.lock > /out/of-a-user
"""


@pytest.mark.slow  # a container more, for two places of locks
def test_a_unit_locks_where_others_do(gateway: Gateway, blocks: Blocks) -> None:
    """Also where ``/run/lock`` is root's alone, as on Arch."""
    ended = gateway.run(
        NODE_EXPORTER, blocks.user_by_systemd, blocks.inventory, gateway.inventory(), blocks.systemd, LOCKS
    )
    assert ended.code == 0, ended
    kept = {name: (ended.left / name).read_text().split() for name in ("in-run", "in-tmp", "of-a-user")}
    assert any("ttyUSB0" in path for path in kept["in-run"]), kept
    assert kept["in-tmp"] == kept["of-a-user"]
    assert any("ttyUSB0" in path for path in kept["in-tmp"]), kept


def test_where_there_is_no_node_exporter(gateway: Gateway, blocks: Blocks) -> None:
    """Nothing of it is needed to set up; the service then says which folder it has not."""
    ended = gateway.run(blocks.user_by_systemd, "test ! -e /var/lib/prometheus", blocks.inventory)
    assert ended.code == 0, ended
    assert "no faults" in ended.out


def test_every_file_is_listed() -> None:
    listed = (EXAMPLES / "README.md").read_text(encoding="utf-8")
    for path in (EXAMPLES / "systemd").iterdir():
        assert f"`systemd/{path.name}`" in listed
