"""A container to install the examples in: this computer's programs; users, folders and systemd of its own.

::

    /usr            this computer's, and over it: fatektool, and a sendmail that keeps what it gets
    /etc            new: users, groups and PAM's rules copied, nothing else
    /opt/project    this project, read-only
    /opt/python     this Python; /opt/packages what it has installed, in a place that all users can read
    /out            what the script leaves
    /dev/ttyUSB0    a pty of a simulated PLC, as a USB adapter would be: for root and dialout

A script runs in it as root, as the last unit that is started; with its end the container ends. The network is
this computer's, so that simulated PLCs are reached.
"""

from __future__ import annotations

import atexit
import contextlib
import functools
import grp
import os
import secrets
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from importlib.util import cache_from_source
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

from tests.root import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

LINKS: Final = ("bin", "sbin", "lib", "lib32", "lib64", "libx32")
COPIED: Final = (
    *("passwd", "group", "shadow", "gshadow", "login.defs", "nsswitch.conf"),
    *("pam.d", "security", "alternatives", "ld.so.cache"),
)
NEEDED: Final = ("systemd-nspawn", "unshare")
PYTHON: Final = f"""#!/bin/sh
export LD_LIBRARY_PATH=/opt/python/lib PYTHONPATH=/opt/project:/opt/packages PYTHONDONTWRITEBYTECODE=1
exec /opt/python/bin/python{sys.version_info[0]}.{sys.version_info[1]} "$@"
"""
PROGRAM: Final = '#!/bin/sh\nexec /usr/local/bin/python-of-the-tests -m fatektool "$@"\n'
SENDMAIL: Final = "#!/bin/sh\ncat >> /out/mail\n"
UNIT: Final = """[Unit]
After=basic.target
Requires=basic.target
SuccessAction=exit-force
FailureAction=exit-force

[Service]
Type=oneshot
Environment=HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
ExecStart=/bin/bash /out/script
StandardOutput=file:/out/stdout
StandardError=file:/out/stderr
"""


class Ended(NamedTuple):
    """What a script left: its exit code, both streams, and the folder ``/out``."""

    code: int
    out: str
    err: str
    left: Path


def run_in_container(
    folder: Path, script: str, *, programs: Mapping[str, str] | None = None, serial_port: str | None = None
) -> Ended:
    """Run a bash script as root in a container of its own.

    Args:
        folder: an empty folder for it.
        script: what is run.
        programs: further programs for ``/usr/local/bin``: name and text.
        serial_port: the pty that is ``/dev/ttyUSB0``.
    """
    root, over, out = folder / "root", folder / "over", folder / "out"
    _make_root(root)
    texts = {"fatektool": PROGRAM, "python-of-the-tests": PYTHON, **(programs or {})}
    for path, text in {
        **{f"local/bin/{name}": text for name, text in texts.items()},
        "sbin/sendmail": SENDMAIL,
    }.items():
        _write(over / path, text, 0o755)
    _write(out / "script", script)
    out.chmod(0o1777)
    words = [
        "systemd-nspawn",
        "--quiet",
        "--register=no",
        "--keep-unit",
        "--link-journal=no",
        "--hostname=gateway",
        "-D",
        str(root),
    ]
    words += [f"--overlay-ro=/usr:{over}:/usr", f"--bind-ro={_project()}:/opt/project", f"--bind={out}:/out"]
    words += [f"--bind-ro={sys.base_prefix}:/opt/python", f"--bind-ro={_packages()}:/opt/packages"]
    if serial_port is not None:
        device = os.path.realpath(serial_port)
        os.chown(device, 0, grp.getgrnam("dialout").gr_gid)
        Path(device).chmod(0o660)
        words.append(f"--bind={device}:/dev/ttyUSB0")
    words += ["--boot", "systemd.unit=script.service", "systemd.show_status=no"]
    with _own_control_groups() as groups:
        enter = [f"echo $$ > {shlex.quote(str(group / 'cgroup.procs'))}" for group in groups]
        # nspawn keeps things in /run, which it wants to be no disk: it gets one of its own.
        steps = [*enter, "mount --make-rprivate /", "mount -t tmpfs tmpfs /run", f"exec {shlex.join(words)}"]
        done = subprocess.run(
            ["unshare", "--mount", "sh", "-c", " && ".join(steps)],
            stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
        )  # fmt: skip
    streams = [out / "stdout", out / "stderr"]
    texts_left = [path.read_text(encoding="utf-8") if path.exists() else "" for path in streams]
    return Ended(done.returncode, texts_left[0], texts_left[1] + done.stderr, out)


@contextlib.contextmanager
def _own_control_groups() -> Iterator[list[Path]]:
    """Control groups for one container, as two systemds in one would end each other's services.

    Whatever is still in them at the end, after a time-out, is killed.
    """
    made: list[Path] = []
    own = f"fatektool-test-{secrets.token_hex(6)}"  # the same in each, as nspawn takes it to be
    hierarchies = {"name=systemd": ("systemd",), "": ("unified", ".")}
    try:
        for line in Path("/proc/self/cgroup").read_text(encoding="utf-8").splitlines():
            _, controllers, path = line.split(":", 2)
            for name in hierarchies.get(controllers, ()):
                parent = Path("/sys/fs/cgroup", name, path.lstrip("/"))
                if (parent / "cgroup.procs").exists():
                    made.append(parent / own)
                    made[-1].mkdir()
                    break
        yield made
    finally:
        for group in made:
            _empty(group)


def _empty(group: Path) -> None:
    groups = [*sorted((path for path in group.rglob("*") if path.is_dir()), reverse=True), group]
    for path in groups:
        for process in (path / "cgroup.procs").read_text(encoding="utf-8").split():
            with contextlib.suppress(ProcessLookupError):
                os.kill(int(process), signal.SIGKILL)
    deadline = time.monotonic() + 5
    while group.exists() and time.monotonic() < deadline:  # as long as processes are just ending
        for path in groups:
            with contextlib.suppress(OSError):
                path.rmdir()
        time.sleep(0.01)


@functools.cache
def why_no_container(folder: Path) -> str | None:
    """Why none can be run here; None if one can."""
    if not hasattr(os, "geteuid") or os.geteuid() != 0:
        return "only root can run a container"
    missing = [name for name in NEEDED if shutil.which(name) is None]
    if missing:
        return f"no {missing[0]} here"
    ended = run_in_container(folder, "echo works")
    return None if ended.out == "works\n" else f"no container here: {ended}"


def _make_root(root: Path) -> None:
    for name in ("etc/systemd/system", "usr", "var/lib", "root", "opt"):
        (root / name).mkdir(parents=True)
    root.chmod(0o755)
    for name in LINKS:
        if Path("/", name).is_symlink():
            (root / name).symlink_to(Path("/", name).readlink())
    for name in COPIED:
        here, there = Path("/etc", name), root / "etc" / name
        if here.is_dir():
            shutil.copytree(here, there)
        elif here.exists():
            shutil.copy2(here, there)
    shutil.copy(os.path.realpath("/etc/os-release"), root / "etc" / "os-release")
    _write(root / "etc/machine-id", "0123456789abcdef0123456789abcdef\n")  # not its first boot: no presets
    _write(root / "etc/hosts", "127.0.0.1 localhost gateway\n")
    _write(root / "etc/hostname", "gateway\n")
    _write(root / "etc/sudoers", "root ALL=(ALL:ALL) NOPASSWD: ALL\n", 0o440)
    _write(root / "etc/systemd/system/script.service", UNIT)


@functools.cache
def _project() -> Path:
    """This project with its compiled files beside their sources, wherever they are kept here."""
    if sys.pycache_prefix is None:
        return ROOT
    folder = Path(tempfile.mkdtemp(prefix="fatektool-project-"))
    atexit.register(shutil.rmtree, folder)
    folder.chmod(0o755)
    for name in ("fatektool", "examples"):
        shutil.copytree(ROOT / name, folder / name)
    for path in (ROOT / "fatektool").rglob("*.py"):
        compiled = Path(cache_from_source(str(path)))
        if compiled.exists():
            there = folder / path.relative_to(ROOT).parent / "__pycache__"
            there.mkdir(exist_ok=True)
            shutil.copy2(compiled, there)
    return folder


def _packages() -> str:
    import click

    return str(Path(click.__file__).parent.parent)


def _write(path: Path, text: str, mode: int = 0o644) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    path.chmod(mode)
