"""Who explains the frames of each protocol, by the name of ``--protocol``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.protocol.facon_explain import FaconExplainer
from fatektool.protocol.modbus_explain import AsciiExplainer, RtuExplainer, TcpExplainer
from fatektool.protocol.mseries_explain import MseriesExplainer

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
