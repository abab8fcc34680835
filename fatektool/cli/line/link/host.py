"""Which PLC it is whose communication registers are shown: its OS as JSON has it, and warnings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fatektool.jobs.plcports.host import LinkHost


def host_document(host: LinkHost) -> dict[str, Any]:
    """The key ``os`` of the documents of ``link``."""
    return {
        "version": host.os_version,
        "fbs": host.fbs,
        "needs": [
            {"what": need.what, "version": need.version, "met": need.met(host.os_version)}
            for need in host.needs
        ],
    }
