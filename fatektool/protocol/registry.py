"""The protocols by name. Each is loaded when it is asked for: who speaks FACON does not wait for Modbus."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.protocol.codec import Codec

_NAMES: Final = ("facon", "mseries", "modbus-rtu", "modbus-ascii", "modbus-tcp")


class Codecs(Mapping[str, "Codec"]):
    """The codec of each name of ``--protocol``, in the order in which they are listed."""

    def __getitem__(self, name: str) -> Codec:
        if name == "facon":
            from fatektool.protocol.fatek.facon.codec import FACON

            return FACON
        if name == "mseries":
            from fatektool.protocol.fatek.mseries.codec import MSERIES

            return MSERIES
        from fatektool.protocol.modbus.codec import ASCII, RTU, TCP

        return {codec.name: codec for codec in (RTU, ASCII, TCP)}[name]

    def __contains__(self, name: object) -> bool:
        return name in _NAMES  # a name is known without its codec

    def __iter__(self) -> Iterator[str]:
        return iter(_NAMES)

    def __len__(self) -> int:
        return len(_NAMES)
