"""``--kind`` of the ``link`` commands: the instruction that a table or result is of."""

from __future__ import annotations

from typing import Final

import click

from fatektool.plcports.kinds import TableKind

KIND: Final = click.Choice([kind.value for kind in TableKind], case_sensitive=False)
