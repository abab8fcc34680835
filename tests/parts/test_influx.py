"""InfluxDB takes the line protocol of ``snapshot``, and gives each value back."""

from __future__ import annotations

import json
import re
import urllib.error
import urllib.parse
import urllib.request
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from fatektool.jobs.snapshots.formats import as_influx
from tests.cli.running import served
from tests.jobs.snapshots.test_formats import NASTY, SECONDS, snapshot
from tests.parts.programs import PATIENCE_S, command, free_port, needs, running

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.cli.running import Cli

CONFIG = """\
reporting-enabled = false
bind-address = "127.0.0.1:{backup}"
[meta]
  dir = "{folder}/meta"
[data]
  dir = "{folder}/data"
  wal-dir = "{folder}/wal"
[monitor]
  store-enabled = false
[http]
  bind-address = "127.0.0.1:{port}"
"""


class Influx:
    """A database of a server of this test."""

    def __init__(self, port: int) -> None:
        self._url = f"http://127.0.0.1:{port}"
        self.ask("CREATE DATABASE plant")

    def write(self, lines: str) -> None:
        """Give it lines, all of which it must take."""
        query = urllib.parse.urlencode({"db": "plant", "precision": "ns"})
        self._post(f"/write?{query}", lines.encode())

    def ask(self, query: str) -> list[dict[str, Any]]:
        """The rows of an answer."""
        words = urllib.parse.urlencode({"db": "plant", "epoch": "s", "q": query})
        (result,) = json.loads(self._post("/query", words.encode()))["results"]
        assert "error" not in result, result
        return [
            dict(zip(series["columns"], row, strict=True))
            for series in result.get("series", [])
            for row in series["values"]
        ]

    def _post(self, path: str, data: bytes) -> bytes:
        request = urllib.request.Request(self._url + path, data)  # noqa: S310  # this computer's own
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:  # noqa: S310
                body: bytes = answer.read()
                return body
        except urllib.error.HTTPError as error:
            raise AssertionError(error.read().decode()) from error


@contextmanager
def influx(folder: Path) -> Iterator[Influx]:
    port = free_port()
    (folder / "influxdb.conf").write_text(CONFIG.format(folder=folder, port=port, backup=free_port()))
    with running(command("influxd", "run", "-config", folder / "influxdb.conf"), "Listening on HTTP"):
        yield Influx(port)


@needs("influxd")
def test_each_value_comes_back(tmp_path: Path) -> None:
    made = snapshot(NASTY, target="tcp://10.0.0.5:500", unit="m/s, gross")
    with influx(tmp_path) as database:
        database.write(as_influx(made))
        rows = {row["key"]: row for row in database.ask("SELECT * FROM fatek")}
    kept = {key: value for key, value in made.values.items() if value is not None}
    assert set(rows) == {re.sub(r"[\n\t\r]", " ", key).replace("\\", "/") for key in kept}
    for key, value in kept.items():
        row = rows[re.sub(r"[\n\t\r]", " ", key).replace("\\", "/")]
        assert row["value" if not isinstance(value, str) else "text"] == value
        assert row["time"] == SECONDS
        assert (row["target"], row["station"], row["unit"]) == ("tcp://10.0.0.5:500", "7", "m/s, gross")


@needs("influxd")
def test_snapshots_of_a_plc(cli: Cli, place: Path) -> None:
    (place / "spec.toml").write_text(
        '[[item]]\nname = "speed"\nelement = "R12"\nscale = 0.1\nunit = "m/min"\n'
        '[[item]]\nname = "code"\nelement = "R13"\ntype = "hex"\n'
        '[[item]]\nname = "valve"\nelement = "Y0"\n'
    )
    with served() as door, influx(place) as database:
        for speed in (100, 200):
            door.simulation.plcs[1].write_words("R", 12, [speed, 0xBEEF])
            done = cli("snapshot", "--spec", "spec.toml", "-p", door.target, "--format", "influx")
            assert done.code == 0, done.err
            # two within one second would be one point
            database.write(re.sub(r" (\d+)$", rf" 1{speed}000000000", done.out, flags=re.MULTILINE))
        found = database.ask('SELECT "key", value, text FROM fatek ORDER BY time')
    values = [(row["key"], row["value"], row["text"]) for row in found]
    assert sorted(values, key=str) == sorted(
        [
            ("speed", 10.0, None),
            ("speed", 20.0, None),
            ("code", None, "BEEF"),
            ("code", None, "BEEF"),
            ("valve", 0, None),
            ("valve", 0, None),
        ],
        key=str,
    )
