"""The playbook, run by a user who is not root and may use sudo, on gateways that are all this container."""

from __future__ import annotations

import importlib.util
import os
import re
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.examples.conftest import Gateway

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(300),  # a process for each task and host, and sudo for most of them
    pytest.mark.skipif(
        importlib.util.find_spec("ansible") is None and not os.environ.get("CI"),
        reason="no ansible-core here",
    ),
]

PROGRAMS = {"ansible-playbook": '#!/bin/sh\nexec python-of-the-tests -m ansible playbook "$@"\n'}
FITTER = """
useradd --create-home --shell /bin/bash fitter
echo 'fitter ALL=(ALL:ALL) NOPASSWD: ALL' >> /etc/sudoers
cp -r examples/ansible /home/fitter/plant
cat > /home/fitter/plant/play <<'END'
export LC_ALL=C.UTF-8 ANSIBLE_FORCE_COLOR=0
cd plant
ansible-playbook -i hosts.ini backup.yml -e ansible_connection=local \
  -e ansible_python_interpreter=/usr/local/bin/python-of-the-tests "$@" 2>&1
END
play() { su - fitter -c "bash plant/play $*" || echo "exit code $?"; }
"""
LOOK = """
stat -c '%U %a' /var/lib/fatektool/history /var/lib/fatektool/fatek.toml > /out/rights
for name in gateway-1 gateway-2; do
  su - fitter -c "fatektool history log --history plant/histories/$name/history"
done
"""


def inventory(**tables: str) -> str:
    text = "".join(f"[plc.{name}]\n{lines}" for name, lines in tables.items())
    return f"cat > /home/fitter/plant/fatek.toml <<'END'\n{text}END\nchown -R fitter /home/fitter\n"


def test_by_ansible(gateway: Gateway) -> None:
    gone = "target = 'tcp://127.0.0.1:1'\ntags = ['gateway-2']\n"
    press = f"target = '{gateway.target}'\ntags = ['gateway-1']\n"
    oven = "target = '/dev/ttyUSB0'\ntags = ['gateway-2']\n"  # readable for the group dialout
    alone = "-l gateway-2 -e fatek_folder=/var/lib/other"
    ended = gateway.run(
        FITTER,
        inventory(gone=gone),
        f"play {alone} > /out/nothing",
        inventory(press=press, oven=oven, gone=gone),
        "play > /out/both",
        LOOK,
        **PROGRAMS,
    )
    assert ended.code == 0, ended
    left = ended.left
    nothing, both = (left / "nothing").read_text(), (left / "both").read_text()
    for said in (nothing, both):
        assert said.endswith("exit code 2\n"), said
        (error,) = re.findall(r"^\[ERROR\]: .*", said, re.MULTILINE)  # that of the PLC alone
        assert "gone: tcp://127.0.0.1:1: cannot connect" in error
        assert "[WARNING]" not in said
    recap = re.findall(r"^(gateway-\d) +: ok=\d+ .*failed=(\d)", both, re.MULTILINE)
    assert recap == [("gateway-1", "0"), ("gateway-2", "1")]
    assert (left / "rights").read_text().splitlines() == ["fatektool 750", "fatektool 640"]
    assert sorted(re.findall(r"(\w+): first backup", ended.out)) == ["oven", "oven", "press", "press"]
