"""Names that open a device on Windows, and none of which is a file there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from fatektool.cli import run
from fatektool.errors import UsageError
from fatektool.files import portable_name
from fatektool.files.atomic import make_folder, read_bounded, require_place, write_whole
from fatektool.files.portable_name import device_of_name, fault_of_name, is_portable_name
from fatektool.transport import target as target_module
from fatektool.transport.serial_line import url
from fatektool.transport.target import Target
from fatektool.transport.trace import open_trace
from tests.rows import each

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


@each(
    ("path", "device"),
    [
        ("com2.json", "COM2"),
        (r"C:\backups\com2.json", "COM2"),
        ("backups/COM9.old.json", "COM9"),
        ("nul", "NUL"),
        ("aux .txt", "AUX"),
        ("LPT\u00b9.json", "LPT\u00b9"),
        ("com2:", "COM2"),
        ("com10.json", None),
        ("com.json", None),
        ("press-com2.json", None),
        ("com2/press.json", None),
        ("", None),
    ],
)
def test_the_device_of_a_name(path: str, device: str | None) -> None:
    assert device_of_name(path) == device


COLON = "a file name cannot contain ':'"
END = "a file name cannot end with a full stop or a space"


@each(
    ("path", "fault"),
    [
        ("press.json", None),
        (r"C:\my plant\press.json", None),
        (r"C:press.json", None),
        (r"\\?\C:\plant\press.json", None),
        (r"\\server\share\press.json", None),
        ("../a.b/press", None),
        (".", None),
        ("", None),
        ("press 10:30.json", COLON),
        (r"C:\plant\press:1.json", COLON),
        ("press?.json", "a file name cannot contain '?'"),
        ('"press.json', "a file name cannot contain '\"'"),
        ("press\n.json", r"a file name cannot contain '\n'"),
        ("press.json.", END),
        ("press.json ", END),
        (r"plant.\press.json", END),
        ("backups/", None),
        ("com2.json", "this name opens the device COM2"),
    ],
)
def test_what_windows_does_not_take_as_a_file(path: str, fault: str | None) -> None:
    assert fault_of_name(path) == fault


@each(("name", "portable"), [("press", True), ("press.1", True), ("press.", False), ("com3", False)])
def test_names_of_plcs_can_be_files_everywhere(name: str, *, portable: bool) -> None:
    assert is_portable_name(name) is portable


@pytest.fixture
def _windows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(portable_name, "WINDOWS", True)
    monkeypatch.setattr(url, "WINDOWS", True)
    monkeypatch.setattr(target_module, "_WINDOWS", True)


@pytest.mark.usefixtures("_windows")
def test_no_file_is_written_or_read_under_such_a_name(tmp_path: Path) -> None:
    path = tmp_path / "com2.json"
    uses: list[Callable[[], object]] = [
        lambda: require_place(path, overwrite=True),
        lambda: write_whole(path, b"{}", overwrite=True),
        lambda: read_bounded(path, 10),
        lambda: Target.parse("sim:com2.json"),
        lambda: make_folder(tmp_path / "com2"),
        lambda: open_trace(tmp_path / "com2.pcap", "facon"),
    ]
    for use in uses:
        with pytest.raises(UsageError, match="on Windows this name opens the device COM2") as caught:
            use()
        assert caught.value.hint == "choose another file name"
    assert not list(tmp_path.iterdir())


WAYS = [
    "backup {}",
    "backup x.json --raw {}",
    "backup x.json --trace {}",
    "restore {} --yes",
    "restore old.json --yes --safety-dir {}",
    "verify {} --report x.html",
    "snapshot R0 -o {} -p sim:",
    "snapshot R0 -o {}/ -p sim:",
    "snapshot R0 --append {}",
    "snapshot diff {} x.json",
    "watch R0 --count 1 --report {}",
    "fleet backup --dir {}",
    "fleet status --prometheus {}",
    "fleet status --inventory {}",
    "inspect {}",
    "history log --history {}",
    "simulate --state {}",
    "simulate --replay {}",
    "check --reference {}",
    "link table check {}",
]


@pytest.mark.usefixtures("_windows")
@pytest.mark.parametrize("name", ["nul.json", "press 10:30.json"])
def test_no_command_takes_such_a_name(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Wherever a user names a file: it is refused before anything is read or written."""
    monkeypatch.chdir(tmp_path)
    for way in WAYS:
        words = [word.format(name) for word in way.split()]
        assert run(words) == 2, way
        said = capsys.readouterr().err
        assert f"{name}: on Windows {fault_of_name(name)}; choose another file name" in said, way
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("_windows")
@pytest.mark.parametrize("name", ["com2.json", r"C:\backups\com2.json", "modem:com2.json?number=1", "nul"])
def test_such_a_name_is_no_port(name: str) -> None:
    with pytest.raises(UsageError, match="on Windows this name opens the device") as caught:
        Target.parse(name)
    assert caught.value.hint == "for a port write its name alone, such as COM2"


@pytest.mark.usefixtures("_windows")
@pytest.mark.parametrize(
    "name", ["COM1", "com1", "COM1:", r"\\.\COM1", r"\\.\com1", r"\\?\COM1", "//./COM1", "spy://com1"]
)
def test_all_names_of_a_port_are_one_line(name: str) -> None:
    assert url.line_name(Target.parse(name).path) == "COM1"


@pytest.mark.usefixtures("_windows")
@each(("device", "line"), [("com12:", "COM12"), (r"\\.\cnca0", r"\\.\CNCA0"), ("cnca0", "CNCA0")])
def test_names_of_other_ports_are_kept_but_for_their_line(device: str, line: str) -> None:
    assert url.line_name(device) == line
    assert url.opened_name(device) == (line if line == "COM12" else device)


@pytest.mark.skipif(portable_name.WINDOWS, reason="on Windows it opens the port")
def test_elsewhere_it_is_a_file_like_others(tmp_path: Path) -> None:
    write_whole(tmp_path / "com2.json", b"{}", overwrite=False)
    assert read_bounded(tmp_path / "com2.json", 10) == b"{}"
