"""``inventory add``: append PLCs to the inventory."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from fatektool.address import CHECKS
from fatektool.cli.many.inventory.documents import add_document
from fatektool.cli.shared.connection_options import ROWS, address_options, given_of
from fatektool.cli.shared.inventory_file import inventory_option
from fatektool.cli.shared.options import PATH, voice_options
from fatektool.cli.shared.pairs import apart
from fatektool.errors import DataError, UsageError
from fatektool.files.atomic import read_bounded, write_whole
from fatektool.inventory.add import with_plc
from fatektool.inventory.find import FILE_NAME, inventory_path
from fatektool.inventory.load import MAX_INVENTORY

if TYPE_CHECKING:
    from fatektool.cli.shared.output import Voice

_ROWS: Final = tuple(row._replace(variable=None) for row in ROWS if row.field in CHECKS)
_OF_SCAN: Final = ("port", "station", "protocol", "baud", "line_format", "old_format")
_MAX_SCAN: Final = 4 << 20


@click.command(
    "add",
    epilog="Example: fatektool scan -p sim: --json | fatektool inventory add hall1 --from -",
)
@click.argument("name")
@click.option(
    "--from", "scan", type=PATH, metavar="FILE|-", help="Output of 'scan --json': add each station."
)
@click.option("--tag", "tags", multiple=True, metavar="WORD", help="A word for --select; repeat for more.")
@address_options(_ROWS)
@inventory_option
@voice_options
def add_command(
    name: str,
    voice: Voice,
    *,
    scan: Path | None,
    tags: tuple[str, ...],
    inventory: Path | None,
    **values: Any,
) -> None:
    """Add a PLC, or all that a scan found.

    A PLC gets the name NAME, those of a scan get NAME-1, NAME-2 and so on, by station.

    They are appended to the inventory, all or none; the rest of the file is not changed. If there is none,
    fatek.toml is created in the current folder. Stations that are in the inventory already are skipped.
    """
    path = inventory_path(inventory) or Path(FILE_NAME)
    data = read_bounded(path, MAX_INVENTORY) if path.exists() else b""
    given = given_of(values, _ROWS)
    if scan is not None:
        apart("scan", *_OF_SCAN, why="the scan has target and settings")
        wanted = {each: found | given for each, found in _scanned(scan, name).items()}
    else:
        if "target" not in given:
            raise UsageError(
                "no PLC is given", hint="give --port TARGET, or --from FILE with the output of a scan"
            )
        wanted = {name: given}
    added = []
    known = _known(data, path) if scan is not None else set()
    for each, keys in wanted.items():
        if scan is not None and (keys["target"], keys["station"]) in known:
            voice.say(
                f"skipped station {keys['station']} on {keys['target']}: it is in the inventory already"
            )
            continue
        data = with_plc(data, path, each, keys | ({"tags": list(tags)} if tags else {}))
        added.append(each)
    if added:
        mode = path.stat().st_mode & 0o777 if path.exists() else 0o644
        write_whole(path, data, overwrite=True, mode=mode)
    voice.show(add_document(path, added), [f"added {each} to {path}" for each in added])


def _known(data: bytes, path: Path) -> set[tuple[str, int]]:
    from fatektool.inventory.entries import parse_inventory

    plcs = parse_inventory(data, path).plcs.values()
    return {(entry.address.target, entry.address.station) for entry in plcs}


def _scanned(scan: Path, name: str) -> dict[str, dict[str, Any]]:
    """The stations in the output of a scan, each once, by their new names.

    Raises:
        DataError: it is not the output of a scan.
        UsageError: the scan found no PLC.
    """
    data = read_bounded(scan, _MAX_SCAN)
    try:
        document = json.loads(data)
        schema = document["schema"]
        target = str(document["target"])
        found = {int(each["station"]): each for each in document["found"][::-1]}
        stations = {
            number: {"target": target, "station": number}
            | {key: each[key] for key in ("protocol", "baud", "format") if each[key] is not None}
            for number, each in sorted(found.items())
        }
    except (ValueError, TypeError, LookupError, RecursionError) as error:
        raise DataError(
            f"{scan}: not what 'fatektool scan --json' prints: {error}", hint="is it the right file?"
        ) from error
    if schema != "fatektool.scan/1":
        raise DataError(f"{scan}: expected schema 'fatektool.scan/1', got {schema!r:.80}")
    if not stations:
        raise UsageError(
            f"{scan}: the scan found no PLC", hint="scan again without --json to see what to try"
        )
    if len(stations) == 1:
        return {name: next(iter(stations.values()))}
    return {f"{name}-{number}": values for number, values in stations.items()}
