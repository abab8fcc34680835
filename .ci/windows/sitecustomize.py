"""What Wine 8 does otherwise than Windows, put right in this Python alone: no part of the project.

msvcrt.locking      a byte that another process has locked is EACCES on Windows
a read of a port    one without an answer is a time-out without an error; Wine reports error 1460
list_ports          its functions of cfgmgr32 are missing; the ports are in the registry
"""

from __future__ import annotations

import errno
import msvcrt
import sys
from importlib.machinery import ModuleSpec

TYPE_CHECKING = False  # each start of Python pays for what is imported here
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any

_locking = msvcrt.locking


def locking(descriptor: int, mode: int, size: int) -> None:
    """Lock a byte as Windows does."""
    try:
        return _locking(descriptor, mode, size)
    except OSError as error:
        if error.errno == errno.EACCES:
            raise
        raise PermissionError(errno.EACCES, "Permission denied") from error


msvcrt.locking = locking


def _of_the_port(module: Any) -> None:
    original = module.Serial.read

    def read(self: Any, size: int = 1) -> bytes:
        try:
            return bytes(original(self, size))
        except module.SerialException as error:
            if ", 1460)" in str(error):
                return b""
            raise

    module.Serial.read = read


def _of_the_list(module: Any) -> None:
    import winreg

    from serial.tools.list_ports_common import ListPortInfo

    def comports(include_links: bool = False) -> list[Any]:  # noqa: ARG001  # its signature
        try:
            with winreg.OpenKey(winreg.HKEY_LOCAL_MACHINE, r"HARDWARE\DEVICEMAP\SERIALCOMM") as key:
                found = [winreg.EnumValue(key, place)[1] for place in range(winreg.QueryInfoKey(key)[1])]
        except OSError:
            found = []
        return [ListPortInfo(name) for name in found]

    module.comports = comports


class _Finder:
    def find_spec(self, name: str, *_: object) -> ModuleSpec | None:
        if name == "serial.tools.list_ports_windows":
            return ModuleSpec(name, _Loader(_of_the_list))
        if name != "serial.serialwin32":
            return None
        from importlib.util import find_spec

        sys.meta_path.remove(self)
        try:
            spec = find_spec(name)
        finally:
            sys.meta_path.insert(0, self)
        if spec is not None:
            spec.loader = _Loader(_of_the_port, spec.loader)
        return spec


class _Loader:
    def __init__(self, change: Callable[[Any], None], inner: Any = None) -> None:
        self.change, self.inner = change, inner

    def create_module(self, spec: ModuleSpec) -> Any:
        return self.inner.create_module(spec) if self.inner else None

    def exec_module(self, module: Any) -> None:
        if self.inner:
            self.inner.exec_module(module)
        self.change(module)


sys.meta_path.insert(0, _Finder())
