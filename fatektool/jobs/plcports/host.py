"""The PLC whose communication registers are shown or written, as far as it matters for them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fatektool.errors import DataError, LineError, PlcRefused
from fatektool.plcports.versions import is_fbs
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.client import Plc
    from fatektool.plcports.versions import Need


@dataclass(frozen=True, slots=True)
class LinkHost:
    """A PLC, and what its registers or table need of it.

    Attributes:
        os_version: as 53 gives it; None if it is not known.
        needs: what only later PLCs have.
    """

    os_version: str | None
    needs: tuple[Need, ...] = ()

    @property
    def fbs(self) -> bool | None:
        """Whether it is an FBs; None if that is not known."""
        return is_fbs(self.os_version)

    def warnings(self) -> Iterator[str]:
        """What a user must know about these registers."""
        if self.fbs is False:
            yield (
                f"this PLC has OS {self.os_version}, so it is no FBs: these registers are documented for the "
                f"FBs series alone, and may be something else here"
            )
            return
        for need in self.needs:
            met = need.met(self.os_version)
            if met is False:
                yield f"{need.what} needs OS {need.version} or later, and this PLC has OS {self.os_version}"
            elif met is None and self.os_version is not None:
                yield (
                    f"{need.what} needs OS {need.version} or later; this PLC reports OS {self.os_version}, "
                    f"so it can have {self.os_version}0 to {self.os_version}9: see the vendor's software"
                )
            elif met is None:
                yield f"{need.what} needs OS {need.version} or later, and this PLC's OS is not known"


def read_host(plc: Plc, needs: tuple[Need, ...] = ()) -> LinkHost:
    """Ask for the OS version (53). That it cannot be had is no error: then it is not known.

    Args:
        plc: the PLC, which has answered already.
        needs: what its registers or table need.
    """
    if Command.DETAILED_STATUS not in plc.link.codec.commands:
        return LinkHost(None, needs)
    try:
        status = plc.detailed_status()
    except (PlcRefused, DataError, LineError):
        return LinkHost(None, needs)
    return LinkHost(None if status.assumed else status.system.os_version, needs)
