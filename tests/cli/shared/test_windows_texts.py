"""Texts as Windows writes them: a byte order mark, its line ends, UTF-16."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.cli.shared.test_streams import SPEC

if TYPE_CHECKING:
    from tests.cli.running import Cli, Press

BOM = b"\xef\xbb\xbf"
READERS = [
    ("old.json", "inspect {}"),
    ("s.json", "snapshot diff {} s.json"),
    ("s.ndjson", "snapshot diff {} s.json"),
    ("spec.toml", "snapshot --spec {} -p sim:"),
    ("spec.toml", "watch --spec {} --count 1 -p sim:"),
    ("t.toml", "link table check {}"),
    ("fatek.toml", "inventory check --inventory {}"),
    ("x.ndjson", "decode {}"),
]


@pytest.mark.parametrize(("file", "words"), READERS)
def test_texts_as_windows_writes_them(press: Press, cli: Cli, file: str, words: str) -> None:
    """A byte order mark is no fault; UTF-16 is one, told in one clear line; so is what is no text."""
    Path("spec.toml").write_text(SPEC, encoding="utf-8")
    Path("fatek.toml").write_text('[plc.x]\ntarget = "sim:"\n')
    Path("t.toml").write_text('kind = "md0"\n[[row]]\n')
    for words_ in ("snapshot R0 -p sim: -o s.json", "snapshot R0 -p sim: --append s.ndjson"):
        assert cli(*words_.split()).code == 0
    assert cli(*["status", "--brief", "-p", "sim:", "--trace", "x.ndjson"]).code == 0
    plain = (press.folder / file).read_bytes()
    as_it_is = cli(*words.format(file).split())
    for name, data in (("bom-", BOM + plain), ("crlf-", BOM + plain.replace(b"\n", b"\r\n"))):
        Path(name + file).write_bytes(data)
        done = cli(*words.format(name + file).split())
        assert done.code == as_it_is.code, done
        assert "Traceback" not in done.err
    for name, encoding in (("utf-16-", "utf-16"), ("le-", "utf-16-le"), ("be-", "utf-16-be")):
        Path(name + file).write_bytes(plain.decode().encode(encoding))
        done = cli(*words.format(name + file).split())
        assert done.code in {1, 2, 5}
        assert "text in UTF-16, expected UTF-8: save it as UTF-8" in done.err + done.out
