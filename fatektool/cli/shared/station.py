"""The station of ``-s``: which numbers there are, the protocol says."""

from __future__ import annotations

from typing import Any

import click


class Station(click.IntRange):
    """1 to 254; 0 and 255 pass, for ``require_station`` to look at when the protocol is known."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Read the number."""
        text = str(value).strip()
        return int(text) if text in {"0", "255"} else super().convert(value, param, ctx)


def require_station(station: int, protocol: str, *, broadcast: bool | None) -> None:
    """Check a station, now that the protocol is known, which may stand in the inventory.

    Args:
        station: 0 to 255.
        protocol: a name of ``--protocol``.
        broadcast: of ``--broadcast``; None for a command without it.

    Raises:
        BadParameter: no PLC is asked under it.
    """
    from fatektool.protocol.registry import codec_named

    if station not in {0, 255} or station in codec_named(protocol).stations or (station == 0 and broadcast):
        return  # any other number that the protocol lacks is refused in its own words when the line is opened
    told = f"{station} is not in the range 1<=x<=254."
    if station == 0 and broadcast is not None:
        told = "0 is every PLC on the line, and none answers: add --broadcast if that is meant"
    raise click.BadParameter(told, param_hint="'-s' / '--station'")
