"""Files appear whole or not at all, whatever goes wrong on the way."""

from __future__ import annotations

import errno
import os
import re
import shutil
import subprocess
import sys
import threading
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.errors import DataError, FatektoolError, FileWarning, UsageError
from fatektool.files.atomic import read_bounded, require_folder, require_place, write_new, write_whole
from tests.platforms import posix, symbolic_links, windows
from tests.users import folder_for_all, no_root, not_as_root_alone

if TYPE_CHECKING:
    from collections.abc import Iterator

OLD, NEW = b"old" * 1000, b"new" * 2000


def names(folder: Path) -> list[str]:
    return sorted(entry.name for entry in folder.iterdir())


def mode(path: Path) -> int:
    return path.stat().st_mode & 0o777


@contextmanager
def umask(mask: int) -> Iterator[None]:
    before = os.umask(mask)
    try:
        yield
    finally:
        os.umask(before)


@pytest.mark.parametrize("overwrite", [False, True])
def test_a_new_file(tmp_path: Path, *, overwrite: bool) -> None:
    path = tmp_path / "file"
    write_whole(path, NEW, overwrite=overwrite)
    assert path.read_bytes() == NEW
    assert names(tmp_path) == ["file"]


@posix("modes of files")
@pytest.mark.parametrize("overwrite", [False, True])
@pytest.mark.parametrize(("mask", "expected"), [(0, 0o640), (0o022, 0o640), (0o077, 0o600)])
def test_the_mode_of_a_new_file(tmp_path: Path, mask: int, expected: int, *, overwrite: bool) -> None:
    with umask(mask):
        write_whole(tmp_path / "file", NEW, overwrite=overwrite)
    assert mode(tmp_path / "file") == expected


def test_a_file_is_replaced_only_if_that_was_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(OLD)
    with pytest.raises(UsageError, match="exists already and is kept"):
        write_whole(path, NEW, overwrite=False)
    assert path.read_bytes() == OLD
    write_whole(path, NEW, overwrite=True)
    assert path.read_bytes() == NEW
    assert names(tmp_path) == ["file"]


@symbolic_links
@pytest.mark.parametrize("there", [True, False])
def test_a_symlink_is_followed(tmp_path: Path, *, there: bool) -> None:
    (tmp_path / "far").mkdir()
    target, link = tmp_path / "far" / "file", tmp_path / "link"
    if there:
        target.write_bytes(OLD)
    link.symlink_to("far/file")
    write_whole(link, NEW, overwrite=there)
    assert link.is_symlink()
    assert target.read_bytes() == NEW
    assert names(tmp_path / "far") == ["file"]
    assert names(tmp_path) == ["far", "link"]


@symbolic_links
def test_a_symlink_that_leads_to_itself(tmp_path: Path) -> None:
    link = tmp_path / "link"
    link.symlink_to("link")
    with pytest.raises(UsageError):
        write_whole(link, NEW, overwrite=False)
    assert names(tmp_path) == ["link"]


@pytest.mark.parametrize("overwrite", [False, True])
@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("missing/file", "not a folder; create it first"),
        ("file/below", "not a folder"),
        (".", "is a folder, expected a file name"),
        pytest.param("x" * 300, "too long", marks=posix("Windows says so when it is written")),
        ("nul\0", "null|a file name cannot contain"),
    ],
)
def test_a_place_that_cannot_be_written(tmp_path: Path, name: str, message: str, *, overwrite: bool) -> None:
    (tmp_path / "file").write_bytes(OLD)
    for attempt in (require_place, lambda path, **options: write_whole(path, NEW, **options)):
        with pytest.raises(UsageError, match=message):
            attempt(tmp_path / name, overwrite=overwrite)
    assert names(tmp_path) == ["file"]


@posix("devices are files; those of Windows are in tests/files/test_device_names.py")
@pytest.mark.parametrize("overwrite", [False, True])
def test_a_device_is_no_file_to_replace(*, overwrite: bool) -> None:
    master, slave = os.openpty()  # a device whose folder takes no files: a fault here costs nobody /dev/null
    device = Path(os.ttyname(slave))
    try:
        with pytest.raises(UsageError, match=f"{device} is a device"):
            write_whole(device, NEW, overwrite=overwrite)
        assert device.is_char_device()
    finally:
        os.close(master)
        os.close(slave)


@posix("modes of folders")
@not_as_root_alone
def test_a_read_only_folder() -> None:
    with folder_for_all() as folder:
        folder.chmod(0o555)
        with no_root(), pytest.raises(UsageError, match="is not writable; choose another folder"):
            write_whole(folder / "file", NEW, overwrite=False)
        assert names(folder) == []


def test_a_read_only_folder_by_what_the_system_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "access", lambda path, how: False)  # noqa: ARG005
    with pytest.raises(UsageError, match="is not writable; choose another folder"):
        require_folder(tmp_path)


@pytest.mark.parametrize("overwrite", [False, True])
@pytest.mark.parametrize(
    "failure",
    [
        (OSError(errno.ENOSPC, "No space left on device"), DataError, "No space left.*free some space"),
        (OSError(errno.EDQUOT, "Disk quota exceeded"), DataError, "free some space"),
        (OSError(errno.EIO, "Input/output error"), DataError, "check the disk"),
        (OSError(errno.EROFS, "Read-only file system"), UsageError, "check the name and the permissions"),
        (KeyboardInterrupt(), KeyboardInterrupt, None),
    ],
    ids=["full", "quota", "broken", "read-only", "ctrl-c"],
)
@pytest.mark.parametrize("step", ["open", "fsync", "link", "replace"])
def test_whatever_fails_the_file_is_old_or_new(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    step: str,
    failure: tuple[BaseException, type[BaseException], str | None],
    *,
    overwrite: bool,
) -> None:
    error, kind, message = failure
    path = tmp_path / "file"
    if overwrite:
        path.write_bytes(OLD)
    failed = fail_at(monkeypatch, step, error)
    taken = step != ("link" if overwrite else "replace")  # each way takes one of the two
    with pytest.raises(kind, match=message) if taken else nullcontext():
        write_whole(path, NEW, overwrite=overwrite)
    assert bool(failed) == taken
    monkeypatch.undo()
    after = path.read_bytes() if path.exists() else None
    assert after in {OLD if overwrite else None, NEW}
    if failed and step in {"open", "fsync"}:
        assert after == (OLD if overwrite else None)
    assert names(tmp_path) in ([], ["file"])


@windows("an open file cannot be replaced")
def test_a_file_that_another_program_has_open(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(OLD)
    with path.open("rb") as other:
        with pytest.raises(UsageError, match=r"cannot write .*file: .* permissions"):
            write_whole(path, NEW, overwrite=True)
        assert other.read() == OLD
    assert path.read_bytes() == OLD
    assert names(tmp_path) == ["file"]
    write_whole(path, NEW, overwrite=True)
    assert path.read_bytes() == NEW


FOLDER_CANNOT = [
    errno.ENOSYS, errno.EBADF, errno.EPERM, errno.EACCES, errno.EROFS, errno.ENOTTY, errno.EIO, errno.ENOSPC
]  # fmt: skip


@posix("folders are synced")
@pytest.mark.parametrize("overwrite", [False, True])
@pytest.mark.parametrize("number", FOLDER_CANNOT, ids=errno.errorcode.__getitem__)
def test_a_folder_that_cannot_be_synced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int, *, overwrite: bool
) -> None:
    """The file has its name by then, and is told of as written."""
    path = tmp_path / "file"
    if overwrite:
        path.write_bytes(OLD)
    failed = fail_at(monkeypatch, "fsync of the folder", OSError(number, os.strerror(number)))
    with pytest.warns(FileWarning, match=f"folder {tmp_path} may be lost in a power cut"):
        write_whole(path, NEW, overwrite=overwrite)
    assert failed
    assert path.read_bytes() == NEW
    assert names(tmp_path) == ["file"]


@posix("folders are synced")
def test_ctrl_c_while_a_folder_is_synced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fail_at(monkeypatch, "fsync of the folder", KeyboardInterrupt())
    with pytest.raises(KeyboardInterrupt):
        write_whole(tmp_path / "file", NEW, overwrite=False)
    assert names(tmp_path) == ["file"]


@pytest.mark.parametrize("number", [errno.ENOSYS, errno.EINVAL], ids=errno.errorcode.__getitem__)
def test_a_file_system_that_cannot_sync(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int) -> None:
    fail_at(monkeypatch, "fsync", OSError(number, os.strerror(number)))
    with pytest.warns(FileWarning, match=f"{re.escape(str(tmp_path))} may be lost in a power cut"):
        write_whole(tmp_path / "file", NEW, overwrite=False)
    assert (tmp_path / "file").read_bytes() == NEW


def test_a_name_that_is_free(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The next one that is free; and where all are taken, or none can be had, there is an end."""
    written = [write_new(tmp_path, "a", "json", NEW).name for _ in range(3)]
    assert written == ["a.json", "a-2.json", "a-3.json"]
    monkeypatch.setattr("fatektool.files.atomic._MOST_NAMES", 3)
    with pytest.raises(UsageError, match="has 3 files of the name a; move them away"):
        write_new(tmp_path, "a", "json", NEW)
    failed = fail_at(monkeypatch, "open", OSError(errno.EACCES, "Permission denied"))
    with pytest.raises(UsageError, match="Permission denied"):
        write_new(tmp_path, "b", "json", NEW)
    assert failed == ["open"], "it was tried again"


def fail_at(monkeypatch: pytest.MonkeyPatch, step: str, error: BaseException) -> list[str]:
    """Let one step of the commit fail; the list is empty until it has."""
    failed: list[str] = []

    def failing(*_: Any, **__: Any) -> None:
        failed.append(step)
        raise error

    if step.startswith("fsync"):
        real, calls = os.fsync, [0]

        def fsync(descriptor: int) -> None:
            calls[0] += 1
            if calls[0] == (2 if "folder" in step else 1):
                failing()
            real(descriptor)

        monkeypatch.setattr(os, "fsync", fsync)
    elif step == "replace":
        monkeypatch.setattr(Path, "replace", failing)
    elif step == "link":
        monkeypatch.setattr(os, "link", failing)
        monkeypatch.setattr(Path, "rename", failing)  # what stands in for a link
    else:
        monkeypatch.setattr(os, "open", failing)
    return failed


def test_a_file_system_without_hard_links(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def link(*_: Any) -> None:
        raise OSError(errno.EPERM, "Operation not permitted")

    monkeypatch.setattr(os, "link", link)
    write_whole(tmp_path / "file", NEW, overwrite=False)
    assert (tmp_path / "file").read_bytes() == NEW
    assert names(tmp_path) == ["file"]


@pytest.mark.parametrize("links", [True, False])
def test_a_file_that_appears_meanwhile_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, links: bool
) -> None:
    path = tmp_path / "file"
    real = os.link

    def link(source: Path, target: Path) -> None:
        path.write_bytes(OLD)
        if not links:
            raise OSError(errno.EPERM, "Operation not permitted")
        real(source, target)

    monkeypatch.setattr(os, "link", link)
    with pytest.raises(UsageError, match="exists already and is kept"):
        write_whole(path, NEW, overwrite=False)
    assert path.read_bytes() == OLD
    assert names(tmp_path) == ["file"]


def test_of_many_writers_one_makes_the_file(tmp_path: Path) -> None:
    path = tmp_path / "file"
    start, won, lost = threading.Barrier(8), [], []

    def write(number: int) -> None:
        start.wait()
        try:
            write_whole(path, bytes([number]) * 5000, overwrite=False)
        except UsageError:
            lost.append(number)
        else:
            won.append(number)

    threads = [threading.Thread(target=write, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    (winner,) = won
    assert len(lost) == 7
    assert path.read_bytes() == bytes([winner]) * 5000
    assert names(tmp_path) == ["file"]


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk of 64 kB."""
    place = tmp_path / "disk"
    place.mkdir()
    mount, umount = shutil.which("mount"), shutil.which("umount")
    if mount is None or umount is None or os.geteuid() != 0:
        pytest.skip("only root can mount a small disk")
    command = [mount, "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(place)]
    if subprocess.run(command, capture_output=True, check=False).returncode:
        pytest.skip("this root may not mount")
    try:
        yield place
    finally:
        subprocess.run([umount, str(place)], check=True)


@posix("a small disk can be mounted")
def test_a_disk_that_is_really_full(small_disk: Path) -> None:
    path = small_disk / "file"
    path.write_bytes(OLD)
    with pytest.raises(DataError, match="No space left on device; free some space") as caught:
        write_whole(path, b"x" * 100_000, overwrite=True)
    assert caught.value.exit_code == 5
    assert path.read_bytes() == OLD
    assert names(small_disk) == ["file"]


@posix("the size of files can be limited")
def test_a_limit_of_file_size(tmp_path: Path) -> None:
    """Another way for a disk to be too small, which every user can try."""
    program = (
        "import sys; from pathlib import Path; from fatektool.files.atomic import write_whole\n"
        "try: write_whole(Path(sys.argv[1]), b'x' * 100_000, overwrite=True)\n"
        "except Exception as error: print(type(error).__name__, error)"
    )
    path = tmp_path / "file"
    path.write_bytes(OLD)
    limited = f"import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (8192, 8192))\n{program}"
    done = subprocess.run(
        [sys.executable, "-c", limited, str(path)], capture_output=True, text=True, check=True
    )
    assert done.stdout.startswith("DataError cannot write")
    assert path.read_bytes() == OLD
    assert names(tmp_path) == ["file"]


def test_reading(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"12345")
    assert read_bounded(path, 5) == b"12345"
    with pytest.raises(DataError, match="expected at most 4 bytes, got more"):
        read_bounded(path, 4)
    with pytest.raises(FatektoolError, match="cannot read"):
        read_bounded(tmp_path / "missing", 5)
