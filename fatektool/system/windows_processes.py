"""Processes of Windows: the ancestors of this one, and groups that end together. For Windows alone."""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Iterator

_PROCESSES: Final = 2  # TH32CS_SNAPPROCESS
_INVALID: Final = ctypes.c_void_p(-1).value

if sys.platform == "win32":
    _KERNEL: Any = ctypes.windll.kernel32
else:  # so that the rest can be loaded and checked on any system; nobody calls it there
    _KERNEL: Any = None


class _Entry(ctypes.Structure):
    """PROCESSENTRY32W of tlhelp32.h."""

    _fields_ = (
        ("dwSize", ctypes.c_uint32),
        ("cntUsage", ctypes.c_uint32),
        ("th32ProcessID", ctypes.c_uint32),
        ("th32DefaultHeapID", ctypes.c_size_t),
        ("th32ModuleID", ctypes.c_uint32),
        ("cntThreads", ctypes.c_uint32),
        ("th32ParentProcessID", ctypes.c_uint32),
        ("pcPriClassBase", ctypes.c_long),
        ("dwFlags", ctypes.c_uint32),
        ("szExeFile", ctypes.c_wchar * 260),
    )


def ancestors() -> Iterator[str]:
    """The programs that started this process, the nearest first: ``cmd.exe``, ``explorer.exe``."""
    return chain(os.getpid(), {number: (parent, name) for number, parent, name in _processes()})


def chain(process: int, processes: dict[int, tuple[int, str]]) -> Iterator[str]:
    """The programs of the ancestors of a process.

    Args:
        process: its number.
        processes: parent and program of each process. A parent may be gone, and its number used again.
    """
    seen = {process}
    while process in processes:
        process = processes[process][0]
        if process in seen or process not in processes:
            return
        seen.add(process)
        yield processes[process][1]


def _processes() -> Iterator[tuple[int, int, str]]:
    _KERNEL.CreateToolhelp32Snapshot.restype = ctypes.c_void_p
    snapshot = _KERNEL.CreateToolhelp32Snapshot(_PROCESSES, 0)
    if snapshot in {None, _INVALID}:
        return
    entry = _Entry(dwSize=ctypes.sizeof(_Entry))
    more = _KERNEL.Process32FirstW(ctypes.c_void_p(snapshot), ctypes.byref(entry))
    while more:
        yield entry.th32ProcessID, entry.th32ParentProcessID, entry.szExeFile
        more = _KERNEL.Process32NextW(ctypes.c_void_p(snapshot), ctypes.byref(entry))
    _KERNEL.CloseHandle(ctypes.c_void_p(snapshot))


class Job:
    """A job object: a process in it, and each process that it starts, can be ended together.

    Args:
        handle: its own.
    """

    def __init__(self, handle: ctypes.c_void_p) -> None:
        self._handle = handle

    @classmethod
    def of(cls, process: int) -> Job | None:
        """A job with a process; None if the system makes none, or the process is in one that allows no other.

        Args:
            process: the handle of the process.
        """
        _KERNEL.CreateJobObjectW.restype = ctypes.c_void_p
        number = _KERNEL.CreateJobObjectW(None, None)
        if not number:
            return None
        made = cls(ctypes.c_void_p(number))
        if not _KERNEL.AssignProcessToJobObject(made._handle, ctypes.c_void_p(process)):
            made.close()
            return None
        return made

    def end(self) -> None:
        """End all processes of the group."""
        _KERNEL.TerminateJobObject(self._handle, 1)

    def close(self) -> None:
        """Forget the group; its processes go on."""
        with contextlib.suppress(OSError):
            _KERNEL.CloseHandle(self._handle)
