"""``snapshot``: a PLC's data to JSON and other formats, compared and written back."""

from __future__ import annotations

import click

from fatektool.cli.shared.lazy_group import LazyGroup, Subcommand, commands


class SnapshotGroup(LazyGroup):
    """``snapshot ELEMENTS`` takes one; ``snapshot diff`` and ``snapshot apply`` are commands."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Put the command's name in front of elements and options."""
        if not args or (args[0] not in self.subcommands and args[0] not in {"--help", "-h"}):
            args = ["take", *args]
        return super().parse_args(ctx, args)


@click.group(
    "snapshot",
    cls=SnapshotGroup,
    sections=commands(
        take=Subcommand("elements.snapshot.take", "Read data from the PLC, in the fewest bytes."),
        diff=Subcommand("elements.snapshot.diff", "Compare two snapshots; no PLC."),
        apply=Subcommand("elements.snapshot.apply", "Write the data of a snapshot back into the PLC."),
    ),
    epilog="Example: fatektool snapshot R0-R99 D4:f32 -p sim: -o snapshots/ --keep 30d",
)
def snapshot_command() -> None:
    """Save a PLC's data to JSON, compare snapshots, write one back.

    'fatektool snapshot ELEMENTS…' is short for 'fatektool snapshot take ELEMENTS…': see 'fatektool snapshot
    take --help' for --spec, --all, --output, --append, --format and --keep.
    """
