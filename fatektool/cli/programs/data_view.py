"""The data in a backup, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.cli.shared.output import shown_time

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.cli.shared.output import Voice
    from fatektool.program.data.part import DataPart


def data_rows(data: DataPart | None) -> Iterator[tuple[str, object]]:
    """What the data are, as rows of name and value; none if there are none."""
    if data is None:
        return
    counts = ", ".join(f"{count} {symbol}" for symbol, count in data.counts.items() if count)
    yield "data", f"{counts}, read in {'RUN' if data.running else 'STOP'} {shown_time(data.time)}"
    if data.disabled:
        held = (f"{name} {'on' if on else 'off'}" for name, on in data.disabled.items())
        yield "disabled", ", ".join(held)
    if data.moving:
        yield "moving", f"{', '.join(data.moving)}: changed while read"
    if data.errors:
        yield "no value", ", ".join(data.errors)
    yield "data sha256", data.sha256


def warn_of_data(data: DataPart, voice: Voice) -> None:
    """Warn of elements without a value."""
    for span, why in data.errors.items():
        voice.warn(f"{span}: {why}")
