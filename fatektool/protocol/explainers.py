"""Who explains the frames of each protocol, by the name of ``--protocol``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.protocol.fatek.facon.explain import FaconExplainer
from fatektool.protocol.fatek.mseries.explain import MseriesExplainer
from fatektool.protocol.modbus.explain import AsciiExplainer, RtuExplainer, TcpExplainer

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.explain import Explainer

EXPLAINERS: Final[dict[str, Callable[[], Explainer]]] = {
    "facon": FaconExplainer,
    "mseries": MseriesExplainer,
    "modbus-rtu": RtuExplainer,
    "modbus-ascii": AsciiExplainer,
    "modbus-tcp": TcpExplainer,
}
