"""The cron jobs, run by Debian's cron as the user of examples/README.md: only their times are changed."""

from __future__ import annotations

import re
import shutil
from typing import TYPE_CHECKING

import pytest

from tests.examples.conftest import NODE_EXPORTER

if TYPE_CHECKING:
    from pathlib import Path

    from tests.examples.conftest import Blocks, Gateway


# Each job at cron's start, and its exit code to 'ended': all else is left to cron.
AT_START = r"""
times='^[*/0-9]+ +[*/0-9]+ +[*/0-9]+ +[*/0-9]+ +[*/0-9]+ +'
crontab -u fatektool -l | sed -E "s#$times(.*)\$#@reboot \1; echo \$? >> /out/ended#" > /out/jobs
crontab -u fatektool /out/jobs
round() {
  rm -f /out/ended /run/crond.reboot
  install -m 0666 /dev/null /out/ended
  systemctl start cron
  until [ "$(wc -l < /out/ended)" -eq "$(grep -c ^@reboot /out/jobs)" ]; do sleep 0.05; done
  systemctl stop cron
  cp /out/ended "/out/ended-$1"
}
"""
LOOK = """
cd /var/lib/fatektool
metrics=/var/lib/prometheus/node-exporter
ls backups press history > /out/kept
wc -l < press.ndjson > /out/lines
stat -c '%U %a %n' . backups press press.ndjson press/* backups/* "$metrics"/* > /out/rights
cat "$metrics"/*.prom > /out/prom
"""


pytestmark = pytest.mark.skipif(shutil.which("cron") is None, reason="no cron here")
GONE = "[plc.gone]\ntarget = 'tcp://127.0.0.1:1'\n"


def set_up(gateway: Gateway, blocks: Blocks, *more: str) -> tuple[str, ...]:
    """What examples/README.md has done before cron starts, with this inventory."""
    return (
        *(NODE_EXPORTER, blocks.user_by_hand, blocks.inventory),
        *(gateway.inventory(*more), blocks.cron, AT_START),
    )


def check_the_failures(left: Path) -> None:
    """Of a round in which one PLC is gone: exit codes, and one mail that names it."""
    mail = (left / "mail").read_text()
    assert mail.count("Subject:") == 1  # of the backup; the other job's words go to Prometheus alone
    assert "To: maintenance@example.com" in mail
    assert re.search(r"^gone +FAILED +no valid answer: tcp://127\.0\.0\.1:1: cannot", mail, re.MULTILINE)


def check_the_files(left: Path, *, snapshots: int) -> None:
    """What each of so many rounds leaves, and whose it is."""
    kept = (left / "kept").read_text().split()
    assert {"press.json", "oven.json", "HEAD"} <= set(kept)
    assert sum(name.startswith("snapshot-st01-") for name in kept) == snapshots
    assert (left / "lines").read_text() == f"{snapshots}\n"
    rights = [line.split() for line in (left / "rights").read_text().splitlines()]
    assert {user for user, _, _ in rights} == {"fatektool"}
    assert {name: mode for _, mode, name in rights if name.endswith(".prom")} == {
        f"/var/lib/prometheus/node-exporter/fatek-{job}.prom": "644" for job in ("backup", "check")
    }
    assert 'fatek_exit_code{job="backup",plc="oven"} 0' in (left / "prom").read_text()


def test_a_night_in_which_a_plc_is_gone(gateway: Gateway, blocks: Blocks) -> None:
    ended = gateway.run(*set_up(gateway, blocks, GONE), "round 1", LOOK)
    assert ended.code == 0, ended
    assert sorted((ended.left / "ended-1").read_text().split()) == ["0", "0", "1", "2"]
    check_the_files(ended.left, snapshots=1)
    check_the_failures(ended.left)


@pytest.mark.slow  # twelve jobs
def test_nights_in_a_row(gateway: Gateway, blocks: Blocks) -> None:
    """Nothing is mailed as long as nothing failed and nothing changed."""
    ended = gateway.run(
        *set_up(gateway, blocks),
        "round 1; round 2",
        "cp /out/mail /out/mail-1 || true",
        LOOK,
        gateway.inventory(GONE),
        "round 3",
    )
    assert ended.code == 0, ended
    left = ended.left
    assert not (left / "mail-1").exists(), (left / "mail-1").read_text()  # cron mails nothing
    assert (left / "ended-2").read_text().split() == ["0"] * 4
    check_the_files(left, snapshots=2)
    assert sorted((left / "ended-3").read_text().split()) == ["0", "0", "1", "2"]
    check_the_failures(left)
