"""The protocols of a simulator, by name; each is loaded when needed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.protocols import Loaded

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fatektool.simulator.slaves.base import SlaveType

SLAVES: Final[Mapping[str, SlaveType]] = Loaded("slave")
