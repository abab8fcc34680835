"""What Nagios reads of ``check``: the state, the line, and the figures one by one."""

from __future__ import annotations

import os
import re
import sys
import threading
import time
from typing import TYPE_CHECKING

import pytest

from fatektool.program.archive import save_backup
from tests.cli.running import NEW, served
from tests.parts.programs import PATIENCE_S, command, needs, running
from tests.program.samples import backup

if TYPE_CHECKING:
    from pathlib import Path

CONFIG = """\
cfg_file={folder}/objects.cfg
log_file={folder}/nagios.log
status_file={folder}/status.dat
object_cache_file={folder}/objects.cache
state_retention_file={folder}/retention.dat
command_file={folder}/nagios.cmd
check_result_path={folder}/results
temp_file={folder}/nagios.tmp
temp_path={folder}
lock_file={folder}/nagios.lock
query_socket={folder}/nagios.qh
nagios_user={user}
nagios_group={group}
interval_length=1
status_update_interval=1
service_inter_check_delay_method=n
check_for_updates=0
check_external_commands=0
execute_host_checks=0
enable_notifications=0
process_performance_data=1
illegal_macro_output_chars=`~$^&"<>
"""

OBJECTS = """\
define timeperiod {
  timeperiod_name always
  alias always
  monday 00:00-24:00
  tuesday 00:00-24:00
  wednesday 00:00-24:00
  thursday 00:00-24:00
  friday 00:00-24:00
  saturday 00:00-24:00
  sunday 00:00-24:00
}
define command {
  command_name nobody
  command_line /bin/true
}
define contact {
  contact_name fitter
  host_notification_period always
  service_notification_period always
  host_notification_commands nobody
  service_notification_commands nobody
}
define host {
  host_name plant
  contacts fitter
  max_check_attempts 1
  check_period always
  notification_period always
}
"""

SERVICE = """\
define command {{
  command_name {name}
  command_line {line}
}}
define service {{
  service_description {name}
  host_name plant
  check_command {name}
  max_check_attempts 1
  check_interval 3600
  retry_interval 3600
  check_period always
  notification_period always
  notification_interval 0
  contacts fitter
}}
"""

LABEL = r"(?:'[^'=]+'|[^'= ]+)"
FIGURE = re.compile(LABEL + r"=-?[0-9.]+(?:us|ms|s|%|B|KB|MB|GB|TB|c)?(?:;[-0-9.:~@]*){0,4}")
"""One figure, as the guidelines for plugins have it: 'label'=value[UOM];[warn];[crit];[min];[max]."""


@pytest.mark.slow  # it takes seconds to start and to end
@needs("nagios4")
@pytest.mark.timeout(180)
def test_nagios_reads_state_line_and_figures(place: Path) -> None:
    save_backup(backup(NEW), place / "new.json")
    (place / "results").mkdir()
    with served() as well, served() as stopped, served() as low:
        well.simulation.plcs[1].running = low.simulation.plcs[1].running = True
        low.simulation.plcs[1].battery_low = True
        (place / "fatek.toml").write_text(
            "".join(
                f'[plc.{name}]\ntarget = "{door.target}"\n'
                for name, door in (("well", well), ("stopped", stopped), ("low", low))
            )
        )
        checks = {
            "well": f"check -p {well.target}",
            "other": f"check -p {well.target} --reference new.json",
            "stopped": f"check -p {stopped.target}",
            "low": f"check -p {low.target}",
            "gone": "check -p tcp://127.0.0.1:1 --retries 0",
            "unknown": "check -p nobody-of-this-name",
            "fleet": "fleet check --inventory fatek.toml",
        }
        found = read_by_nagios(place, checks)
    states = {name: int(each["current_state"]) for name, each in found.items()}
    assert states == {"well": 0, "other": 2, "stopped": 2, "low": 1, "gone": 2, "unknown": 3, "fleet": 2}
    words = {0: "OK", 1: "WARNING", 2: "CRITICAL", 3: "UNKNOWN"}
    for name, each in found.items():
        assert each["plugin_output"].startswith(f"FATEK {words[states[name]]} - "), name
        assert "|" not in each["plugin_output"]
        rest = FIGURE.sub("", each["performance_data"]).strip()
        assert not rest, (name, rest)
    assert "RUN" in found["well"]["plugin_output"]
    assert 0 < figure(found["well"], "response") < PATIENCE_S
    assert figure(found["well"], "running") == 1
    assert figure(found["low"], "battery_low") == 1
    assert figure(found["fleet"], "critical") == 1
    assert figure(found["fleet"], "warning") == 1
    assert figure(found["fleet"], "ok") == 1
    assert "stopped" in found["fleet"]["plugin_output"]


def figure(service: dict[str, str], name: str) -> float:
    match = re.search(rf"\b{name}=([0-9.]+)", service["performance_data"])
    assert match is not None, service["performance_data"]
    return float(match[1])


def read_by_nagios(folder: Path, checks: dict[str, str]) -> dict[str, dict[str, str]]:
    """What stands in Nagios' status file of each check, when it has made all."""
    import grp  # POSIX only, as Nagios is
    import pwd

    user, group = pwd.getpwuid(os.getuid()).pw_name, grp.getgrgid(os.getgid()).gr_name
    (folder / "nagios.cfg").write_text(CONFIG.format(folder=folder, user=user, group=group))
    # A shell's words: Nagios splits at ! and ends at ;, of which these have none.
    program = f"/usr/bin/env -C {folder} {sys.executable} -m fatektool"
    text = OBJECTS + "".join(
        SERVICE.format(name=name, line=f"{program} {words}") for name, words in checks.items()
    )
    (folder / "objects.cfg").write_text(text)
    with running(command("nagios4", folder / "nagios.cfg"), "Successfully launched command file worker"):
        deadline = time.monotonic() + 4 * PATIENCE_S
        while True:
            found = services(folder / "status.dat")
            if len(found) == len(checks) and all(each["has_been_checked"] == "1" for each in found.values()):
                return found
            assert time.monotonic() < deadline, (folder / "nagios.log").read_text()
            threading.Event().wait(0.1)


def services(status: Path) -> dict[str, dict[str, str]]:
    """The services of a status file."""
    if not status.exists():
        return {}
    found = {}
    for block in re.findall(r"^servicestatus \{\n(.*?)^\t\}", status.read_text(), re.DOTALL | re.MULTILINE):
        fields = dict(re.findall(r"^\t(\w+)=(.*)$", block, re.MULTILINE))
        found[fields["service_description"]] = fields
    return found
