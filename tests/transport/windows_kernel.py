"""pyserial's own port of Windows over a kernel that is none: what it raises there is raised here too.

Each function of the kernel does nothing and succeeds, until a test makes it fail with an error number.
"""

from __future__ import annotations

import ctypes
import importlib
import sys
from typing import TYPE_CHECKING, Any, Final

import serial

if TYPE_CHECKING:
    from collections.abc import Callable

    import pytest

_HANDLE: Final = 7
_INVALID: Final = ctypes.c_void_p(-1).value
_NOT_FOUND: Final = {2, 3, 15, 53, 161}
_DENIED: Final = {5, *range(19, 37)}
_ENOENT, _EACCES, _EINVAL = 2, 13, 22


class Kernel:
    """A kernel32.dll.

    Attributes:
        failing: error number by the name of a function.
        text: the system's text for each error.
        files: the names that were opened.
    """

    def __init__(self) -> None:
        self.failing: dict[str, int] = {}
        self.text = "Access is denied."
        self.files: list[str] = []
        self.last = 0
        self._functions: dict[str, Any] = {}

    def __getattr__(self, name: str) -> Any:
        if name not in self._functions:
            self._functions[name] = type("Function", (), {"__call__": self._function(name)})()
        return self._functions[name]

    def _function(self, name: str) -> Callable[..., object]:
        def called(_: object, *words: Any) -> object:
            if name == "GetLastError":
                return self.last
            self.last = self.failing.get(name, 0)
            if name == "CreateFileW":
                self.files.append(words[0])
                return _INVALID if self.last else _HANDLE
            if name == "WriteFile" and not self.last and "GetOverlappedResult" not in self.failing:
                words[3]._obj.value = words[2]  # what byref points to
            return not self.last

        return called

    def error(self) -> OSError:
        """``ctypes.WinError()``; the numbers of the C library as CPython's PC/errmap.h has them."""
        number = _ENOENT if self.last in _NOT_FOUND else _EACCES if self.last in _DENIED else _EINVAL
        return OSError(number, self.text, None, self.last)


def windows_ports(monkeypatch: pytest.MonkeyPatch) -> Kernel:
    """Have pyserial open ports as on Windows, over the kernel that is returned."""
    kernel = Kernel()
    with monkeypatch.context() as importing:
        importing.setattr(ctypes, "WinDLL", lambda _name: kernel, raising=False)
        for name in ("serial.win32", "serial.serialwin32"):
            monkeypatch.delitem(sys.modules, name, raising=False)
            monkeypatch.delattr(name, raising=False)  # of the package: it would be taken from there
        module = importlib.import_module("serial.serialwin32")
    monkeypatch.setattr(ctypes, "WinError", kernel.error, raising=False)
    monkeypatch.setattr(serial, "Serial", module.Serial)
    return kernel
