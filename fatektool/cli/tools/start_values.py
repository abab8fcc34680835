"""Start values of simulated PLCs: ``--set R0=4660`` and ``--memory FILE``, a snapshot.

The client's parsers read them; they are set in the memory as the PLC's own hardware would, inputs too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.errors import UsageError
from fatektool.simulator.plc import FLAGS
from fatektool.simulator.refusal import Refusal

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from fatektool.protocol.elements import Element
    from fatektool.simulator.plc import SimulatedPlc


class StartValue(click.ParamType):  # type: ignore[type-arg]  # a generic in the newest click only
    """A state of the PLC by its name, or ELEMENT=VALUE."""

    name = "state or value"

    def convert(self, value: str, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Check that it is one of them."""
        if value in FLAGS or "=" in value:
            return value
        states = ", ".join(FLAGS)
        return self.fail(
            f"{value[:60]!r}: expected ELEMENT=VALUE, such as R0=4660, or one of {states}", param, ctx
        )

    def get_metavar(self, param: click.Parameter, ctx: click.Context | None = None) -> str:  # noqa: ARG002
        """What the help writes for a value."""
        return "STATE|ELEMENT=VALUE"

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[click.shell_completion.CompletionItem]:
        """The names of states that begin with this."""
        from click.shell_completion import CompletionItem

        del ctx, param
        return [CompletionItem(flag) for flag in FLAGS if flag.startswith(incomplete)]


def start_values(texts: Iterable[str], memory: Path | None) -> list[tuple[Element, int]]:
    """Values by element, raw: those of the snapshot, then those that are given one by one.

    Raises:
        UsageError: no such element, or a value that it cannot have; or no such file.
        DataError: the file is not a snapshot, or is damaged.
    """
    found: list[tuple[Element, int]] = []
    if memory is not None:
        from fatektool.jobs.snapshots.snapshot import load_snapshot, raw_of

        found += [
            (element, raw) for element, raw in raw_of(load_snapshot(memory)).values() if raw is not None
        ]
    if texts:
        from fatektool.jobs.elements.assignment import parse_assignments

        found += [(item.element, raw) for item, raw in parse_assignments(texts)]
    return found


def set_values(plc: SimulatedPlc, values: Iterable[tuple[Element, int]]) -> None:
    """Set start values in a PLC.

    Raises:
        UsageError: its model does not have one of the elements.
    """
    for element, raw in values:
        try:
            plc.memory.preset(element.symbol, element.address, raw)
        except Refusal:
            raise UsageError(
                f"{element}: the simulated {plc.model.name} does not have it",
                hint="choose another --model or element",
            ) from None
