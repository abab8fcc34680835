from __future__ import annotations

import copy
import json
from importlib.resources import files as package_files
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from fatektool.errors import DataError, FatektoolError, UsageError
from fatektool.program.archive import Backup, Source, load_backup, save_backup
from fatektool.program.image import Program
from fatektool.program.plc_record import SHAPE
from tests.program.fbs import fbs_program
from tests.program.samples import backup, document, file_of, header, plc_record, program
from tests.rows import each

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

SCHEMA = Draft202012Validator(
    json.loads((package_files("fatektool") / "schemas" / "backup.json").read_text())
)

TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=40)


@st.composite
def backups(draw: st.DrawFn) -> Backup:
    words = draw(st.integers(1, 1000))
    page0 = draw(st.one_of(st.just(header(words)), st.binary(min_size=128, max_size=128)))
    record = plc_record(words)
    for flag in record["status"]:
        record["status"][flag] = draw(st.booleans())
    source = Source(draw(TEXT), draw(st.integers(1, 254)), "facon", draw(st.none() | TEXT))
    image = program(words, draw(st.integers(0, 9)), page0)
    return Backup(image, "2026-11-22T03:15:00Z", draw(TEXT), source, record, draw(st.integers(1, 5)))


@given(backups())
def test_what_is_written_is_read_again(kept: Backup) -> None:
    data = kept.to_bytes()
    assert Backup.parse(data) == kept
    SCHEMA.validate(json.loads(data))


def test_the_file_has_its_keys_in_order_and_a_page_a_line() -> None:
    kept = backup(program(100))
    page_lines = ",\n".join(f'  "{page.hex().upper()}"' for page in kept.program.pages)
    found = kept.to_bytes().decode()
    assert found.endswith(f'\n "pages": [\n{page_lines}\n ]\n}}\n')
    top = json.loads(found)
    keys = "schema created tool source plc header ladder_words page_count passes sha256 pages"
    assert " ".join(top) == keys
    assert list(top["source"]) == ["target", "station", "protocol", "line"]
    assert list(top["plc"]) == ["status", "system"]
    said = {
        "valid": True,
        "family": "facon",
        "signature": "FB30",
        "byte_order": "as paper",
        "ladder_words": 100,
        "code_words": None,
        "capacity_words": None,
        "checksum": None,
        "sums": None,
    }
    assert list(top["header"].items()) == list(said.items())


def test_a_change_of_one_page_is_a_change_of_two_lines() -> None:
    one = backup(program(400)).to_bytes().splitlines()
    image = program(400)
    pages = [*image.pages[:5], b"\0" * 128, *image.pages[6:]]
    other = backup(Program(400, tuple(pages))).to_bytes().splitlines()
    differ = [a for a, b in zip(one, other, strict=True) if a != b]
    assert len(differ) == 2
    assert differ[0].startswith(b' "sha256"')


def test_a_header_that_does_not_hold_is_kept_and_marked() -> None:
    image = program(400, page0=b"\xff" * 128)
    found = Backup.parse(backup(image).to_bytes()).header_document
    assert (found["valid"], found["family"], found["signature"]) == (False, None, None)


@pytest.mark.parametrize(
    ("image", "short"),
    [
        (program(400), {"valid": True, "signature": "FB30", "ladder_words": 400}),
        (
            Program(400, (b"BF03" + b"\x90\x01" + b"\xff" * 122, *program(400).pages[1:])),
            {"valid": False, "signature": "BF03", "ladder_words": 0x9001},
        ),
        (
            Program(0x8000, (*fbs_program().pages, b"\xff" * 128)),
            {"valid": False, "signature": "FBS4", "ladder_words": 0x3030},
        ),
    ],
    ids=["facon", "facon swapped", "fbs"],
)
def test_a_file_from_before_there_were_families_is_read(image: Program, short: dict[str, Any]) -> None:
    top = document(image)
    top["header"] = short
    SCHEMA.validate(top)
    assert Backup.parse(file_of(top)).program == image
    for key in short:
        top["header"] = short | {key: "FB31" if key == "signature" else 5}
        with pytest.raises(DataError, match=rf"header\.{key}"):
            Backup.parse(file_of(top))


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("count", [320, 512])
def test_an_fbs_image_is_kept_with_its_sums(count: int, *, swapped: bool) -> None:
    image = fbs_program(count, swapped=swapped)
    top = document(image)
    SCHEMA.validate(top)
    assert top["page_count"] == count
    assert top["header"]["checksum"] == {"stored": "4A57", "computed": "4A57", "valid": True}
    assert Backup.parse(file_of(top)).program == image
    top["header"]["checksum"]["valid"] = False
    with pytest.raises(DataError, match=r"header\.checksum"):
        Backup.parse(file_of(top))


# --- damage -------------------------------------------------------------------------------------------


def put(*path: str | int, value: Any) -> Callable[[dict[str, Any]], None]:
    def change(top: Any) -> None:
        for key in path[:-1]:
            top = top[key]
        top[path[-1]] = value

    change.__name__ = f"{'.'.join(map(str, path))}={value!r}"[:60]
    return change


def drop(*path: str) -> Callable[[dict[str, Any]], None]:
    def change(top: Any) -> None:
        for key in path[:-1]:
            top = top[key]
        del top[path[-1]]

    change.__name__ = f"no {'.'.join(path)}"
    return change


def cut(count: int) -> Callable[[dict[str, Any]], None]:
    def change(top: Any) -> None:
        del top["pages"][count:]
        top["page_count"] = count

    change.__name__ = f"cut to {count}"
    return change


DEEP: list[Any] = []
for _ in range(200):
    DEEP = [DEEP]

DAMAGE = [
    (put("schema", value="fatektool.backup/2"), "expected schema '.*/1', got 'fatektool.backup/2'"),
    (put("schema", value=1), "expected schema"),
    (put("schema", value=DEEP), "expected schema"),
    (drop("schema"), "expected schema"),
    (drop("pages"), "pages: expected an array"),
    (put("pages", value={}), "pages: expected an array"),
    (cut(6), "pages: expected 8 for 400 words, got 6"),
    (put("page_count", value=9), "page_count: expected 8 from the pages"),
    (put("page_count", value=True), "page_count: expected 8 from the pages, got True"),
    (put("page_count", value=8.0), "page_count: expected 8 from the pages, got 8.0"),
    (drop("page_count"), "page_count: expected 8 from the pages, got None"),
    (put("pages", value=[]), "pages: expected 8 for 400 words, got 0"),
    (put("pages", 3, value="AB"), "page 3: expected 256 hex digits, got 'AB'"),
    (put("pages", 3, value="A" * 257), "page 3: expected 256 hex digits, .*257 characters"),
    (put("pages", 3, value="G" * 256), "page 3: expected 256 hex digits"),
    (put("pages", 3, value="Ａ" * 256), "page 3: expected 256 hex digits"),  # noqa: RUF001  # full width
    (put("pages", 3, value=" " * 256), "page 3: expected 256 hex digits"),
    (put("pages", 0, value=None), "page 0: expected 256 hex digits, got None"),
    (put("pages", 7, value=DEEP), "page 7: expected 256 hex digits"),
    (put("pages", 3, value="00" * 128), "sha256: expected"),
    (put("sha256", value="0" * 64), "sha256: expected"),
    (put("sha256", value=None), "sha256: expected a text"),
    (put("header", "valid", value=False), "header.valid .page 0.: expected True from the pages, got False"),
    (put("header", "valid", value=1), r"header.valid \(page 0\): expected True"),
    (put("header", "signature", value="FM30"), r"header.signature \(page 0\): expected 'FB30'"),
    (put("header", "ladder_words", value=401), r"header.ladder_words \(page 0\): expected 400"),
    (drop("header"), "header: expected an object"),
    (put("ladder_words", value=0), "ladder_words: expected a whole number of 1 to 65535"),
    (put("ladder_words", value=65536), "ladder_words: expected a whole number of 1 to 65535"),
    (put("ladder_words", value=400.0), "ladder_words: expected a whole number"),
    (put("ladder_words", value=True), "ladder_words: expected a whole number"),
    (put("ladder_words", value="400"), "ladder_words: expected a whole number"),
    (put("ladder_words", value=401), "header.valid .page 0.|header.ladder_words"),
    (put("passes", value=0), "passes: expected a whole number"),
    (put("passes", value=True), "passes: expected a whole number"),
    (put("created", value="2026-11-22 03:15:00"), "created: expected a UTC time"),
    (put("created", value="2026-11-22T03:15:00+01:00"), "created: expected a UTC time"),
    (put("created", value="2026-13-22T03:15:00Z"), "created: expected a UTC time"),
    (put("created", value="2026-11-22T03:15:00Z\n"), "created: expected a UTC time"),
    (put("created", value=DEEP), "created: expected a text"),
    (put("tool", value=None), "tool: expected a text"),
    (put("source", value=[]), "source: expected an object"),
    (put("source", "station", value=0), "source.station: expected a whole number of 1 to 254"),
    (put("source", "station", value=255), "source.station: expected a whole number of 1 to 254"),
    (put("source", "line", value=9600), "source.line: expected a text or null"),
    (drop("source", "target"), "source.target: expected a text"),
    (put("plc", value=None), "plc: expected an object"),
    (drop("plc", "system"), "plc: expected an object of status, system"),
    (put("plc", "status", value={}), "plc.status: expected an object of running, battery_low"),
    (put("plc", "status", "running", value=1), "plc.status.running: expected true or false, got 1"),
    (put("plc", "system", "timers", value=1e999), "Infinity is not JSON"),
    (put("plc", "system", "timers", value=True), "plc.system.timers: expected a whole number"),
    (put("plc", "system", "timers", value=65536), "plc.system.timers: expected a whole number"),
    (put("plc", "system", "timers", value=DEEP), "plc.system.timers: expected a whole number"),
    (put("plc", "system", "os_version", value="31"), "plc.system.os_version: expected a version"),
    (put("plc", "system", "unit_type", value=1), "plc.system.unit_type: expected an object of code, name"),
    (put("plc", "system", "unit_type", "name", value=5), "unit_type.name: expected a text or null"),
    (put("plc", "system", "main_unit_points", "points", value=True), "expected a whole number or null"),
    (put("plc", "system", "ladder_words", value=401), "plc.system.ladder_words: expected 400"),
]  # fmt: skip


@each(("damage", "message"), DAMAGE, ids=lambda row: row[1])
def test_damage_is_refused_and_named(damage: Callable[[dict[str, Any]], None], message: str) -> None:
    top = document(program(400))
    damage(top)
    with pytest.raises(DataError, match=message) as caught:
        Backup.parse(file_of(top), "press.json")
    assert caught.value.exit_code == 5
    assert caught.value.message.startswith("press.json: ")
    assert caught.value.hint
    assert len(str(caught.value)) < 500
    assert caught.value.details["file"] == "press.json"


def test_a_damaged_page_is_a_value_for_scripts_too() -> None:
    top = document()
    top["pages"][6] = "nonsense"
    with pytest.raises(DataError) as caught:
        Backup.parse(file_of(top))
    assert caught.value.details["page"] == 6


WHOLE = backup(program(1)).to_bytes()


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "the file is empty"),
        (b" \r\n", "the file is empty"),
        (b"\0" * 5000, "only NUL bytes, as after a power cut"),
        (b"[]", r"got \[\]"),
        (b"null", "got None"),
        (b"{}", "got None"),
        (b"\xff\xfe\x00", "text in UTF-16, expected UTF-8"),
        (WHOLE.decode().encode("utf-16"), "text in UTF-16, expected UTF-8"),
        (b"\xef\xbb\xbf\xff" + WHOLE, "byte 3 is FF"),
        (WHOLE + WHOLE, "Extra data"),
        (WHOLE.replace(b'"passes": 2', b'"passes": 2, "passes": 2'), "the key 'passes' occurs twice"),
        (WHOLE.replace(b'"passes": 2', b'"passes": NaN'), "NaN is not JSON"),
        (WHOLE.replace(b'"passes": 2', b'"passes": -Infinity'), "-Infinity is not JSON"),
        (WHOLE.replace(b'"passes": 2', b'"passes": 1e999'), "passes: expected a whole number"),
        (WHOLE.replace(b'"passes": 2', b'"passes": ' + b"9" * 9000), "not a backup file"),
        (b"[" * 100_000, "too deep"),
        (b'{"schema":' * 100_000, "too deep"),
    ],
    ids=range(17),
)
def test_what_is_no_backup_at_all(data: bytes, message: str) -> None:
    with pytest.raises(DataError, match=message):
        Backup.parse(data)


def test_a_file_that_was_cut_off_anywhere() -> None:
    for end in range(len(WHOLE) - 1):
        with pytest.raises(DataError):
            Backup.parse(WHOLE[:end])


@given(st.binary(max_size=300))
def test_random_bytes_are_no_backup(data: bytes) -> None:
    with pytest.raises(DataError):
        Backup.parse(data)


@given(st.integers(0, len(WHOLE) - 1), st.integers(1, 255))
def test_a_wrong_byte_is_found_or_changes_no_page(place: int, flip: int) -> None:
    data = bytearray(WHOLE)
    data[place] ^= flip
    try:
        found = Backup.parse(bytes(data))
    except DataError:
        return
    assert found.program == program(1)


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=8,
)


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    found = [path] if path else []
    if isinstance(value, dict):
        for key in value:
            found += places(value[key], (*path, key))
    elif isinstance(value, list):
        for number, entry in enumerate(value):
            found += places(entry, (*path, number))
    return found


@given(st.sampled_from(places(document(program(1)))), JSON)
def test_any_value_anywhere_is_taken_or_refused(path: tuple[Any, ...], value: Any) -> None:
    top = copy.deepcopy(document(program(1)))
    put(*path, value=value)(top)
    try:
        found = Backup.parse(file_of(top))
    except DataError:
        return
    assert found.program == program(1)
    again = found.to_bytes()
    assert Backup.parse(again) == found
    SCHEMA.validate(json.loads(again))


def test_the_plc_record_is_the_one_of_the_schema() -> None:
    schema: Any = SCHEMA.schema
    properties = schema["properties"]["plc"]["properties"]
    for part in ("status", "system"):
        assert list(SHAPE[part]) == list(properties[part]["properties"])


# --- files --------------------------------------------------------------------------------------------


def test_a_backup_is_saved_and_loaded(tmp_path: Path) -> None:
    path = tmp_path / "press.json"
    save_backup(backup(), path)
    assert load_backup(path) == backup()
    assert [entry.name for entry in tmp_path.iterdir()] == ["press.json"]


def test_a_file_is_kept_unless_it_may_be_replaced(tmp_path: Path) -> None:
    path = tmp_path / "press.json"
    save_backup(backup(), path)
    with pytest.raises(UsageError, match="exists already and is kept; choose another name, or --force"):
        save_backup(backup(program(64)), path)
    assert load_backup(path) == backup()
    save_backup(backup(program(64)), path, overwrite=True)
    assert load_backup(path) == backup(program(64))


def test_a_huge_file_is_not_read_whole(tmp_path: Path) -> None:
    path = tmp_path / "huge.json"
    with path.open("wb") as file:
        file.truncate(1 << 34)
    with pytest.raises(DataError, match="expected at most 4194304 bytes"):
        load_backup(path)


@pytest.mark.parametrize("name", ["missing.json", ".", "missing/press.json", "x" * 300, "nul\0"])
def test_a_file_that_cannot_be_read(tmp_path: Path, name: str) -> None:
    with pytest.raises(FatektoolError, match=r"cannot read|a file name cannot contain") as caught:
        load_backup(tmp_path / name)
    assert caught.value.exit_code == 2
