"""Project files: read whole, in the author's language; cut, damaged and foreign ones refused."""

from __future__ import annotations

import random
import struct

import pytest

from fatektool.errors import DataError, UsageError
from fatektool.ladder.image import fbe_code, fbs_code, words_of_image
from fatektool.project.code_page import code_page
from fatektool.project.file import Project, is_project
from tests.project.images import CODE, FBS, image_of
from tests.project.pdw import enciphered, head, key_of, project, record

SUB = [0x53EF, 0xD422, 0xC424, 0x0018, 0x8EF4]
IMAGE = image_of(CODE, SUB)
GOOD = project(
    IMAGE,
    FBS,
    elements={"X0": b"START", "M0000": b"", "Y00000": b"MOTOR\0junk"},
    networks={0x0200: b"Motor on"},
    units={0x0200: b"MAIN", 0x020A: b"SUB"},
)


def test_what_a_project_holds() -> None:
    found = Project.parse(GOOD)
    assert is_project(GOOD)
    assert found.model == "FBs-24MA"
    assert found.comments.name == "PRESS"
    assert found.comments.model == "FBs-24MA"
    assert found.comments.elements == {"X0": "START", "Y0": "MOTOR"}
    assert found.comments.networks == {0x0200: "Motor on"}
    assert found.comments.units == {0x0200: "MAIN", 0x020A: "SUB"}
    assert found.sha256 == Project.parse(project(IMAGE, FBS, seed=99)).sha256
    assert found.file_sha256 != found.sha256


def test_its_code() -> None:
    code = fbs_code(words_of_image(Project.parse(GOOD).memory.image))
    assert [found.text for found in code.instructions] == [
        "ORG X0",
        "OR M0",
        "AND NOT X0",
        "OUT Y0",
        "~FUN 65 LBL SETID0",
        "~FUN 68 RTS",
    ]
    assert [(network.unit, network.word, 2 * network.place) for network in code.networks] == [
        (0, 0, 0x0200),
        (1, 4, 0x020A),
    ]


@pytest.mark.parametrize(
    ("page", "texts"),
    [
        ("cp1250", ["Silnik główny", "Zawór", "Czujnik ciśnienia", "Grzałka"]),
        ("cp1252", ["Förderband läuft", "Außentür", "Arrêt", "Température élevée"]),
        ("cp1254", ["Çalıştır", "Isıtıcı", "Basınç", "Yağ pompası"]),  # noqa: RUF001  # Turkish
        ("cp932", ["モーター起動", "非常停止", "ポンプ運転"]),
        ("cp936", ["启动", "停止", "1号电机启动", "手动/自动"]),
        ("cp950", ["啟動", "馬達正轉", "緊急停止", "溫度"]),
    ],
)
def test_comments_in_the_authors_code_page(page: str, texts: list[str]) -> None:
    elements = {f"M{number}": text.encode(page) for number, text in enumerate(texts)}
    found = Project.parse(project(IMAGE, FBS, elements=elements)).comments
    assert (found.code_page, found.sure) == (page, True)
    assert list(found.elements.values()) == texts


@pytest.mark.parametrize(
    ("page", "text"),
    [
        ("cp1250", "Ohřev zap"),
        ("cp1250", "Töltő szelep"),
        ("cp1250", "Dzień"),
        ("cp1250", "Průtok"),
        ("cp1252", "Trykk høyt"),
        ("cp1252", "Señal"),
        ("cp1252", "Emissões"),
        ("cp1252", "Pièce"),
        ("cp1254", "Soğutma"),
    ],
)
def test_one_comment_may_be_enough(page: str, text: str) -> None:
    found = Project.parse(project(IMAGE, FBS, elements={"X0": text.encode(page)})).comments
    assert (found.code_page, found.elements["X0"]) == (page, text)


@pytest.mark.parametrize(
    ("page", "text"),
    [
        ("cp1251", "Насос 1"),  # noqa: RUF001  # Cyrillic
        ("cp1253", "Αντλία"),
        ("cp1256", "پمپ آب"),
        ("cp1258", "Bơm"),
        ("cp874", "ปั๊มน้ำ"),
        ("cp949", "펌프 기동"),
    ],
)
def test_a_code_page_that_must_be_named(page: str, text: str) -> None:
    data = project(IMAGE, FBS, elements={"X0": text.encode(page)})
    assert Project.parse(data, encoding=code_page(page)).comments.elements == {"X0": text}


def test_a_comment_cut_within_a_character() -> None:
    text = "AB1号电机正转启动了".encode("cp936")[:16]
    elements = {"X0": text, "X1": "停止".encode("cp936")}
    found = Project.parse(project(IMAGE, FBS, elements=elements)).comments
    assert (found.code_page, found.sure) == ("cp936", True)
    assert found.elements["X0"] == "AB1号电机正转启"
    short = Project.parse(project(IMAGE, FBS, elements={"X0": text[:6]}), encoding="cp936").comments
    assert short.elements["X0"].startswith("AB1号")


def test_a_named_code_page_wins() -> None:
    data = project(IMAGE, FBS, elements={"X0": "Błąd".encode("cp1250")})
    assert Project.parse(data, encoding="cp1252").comments.elements == {"X0": "B³¹d"}
    assert code_page("cp950") == "cp950"
    with pytest.raises(UsageError, match="expected cp1250"):
        code_page("utf-8")


def test_no_code_page_at_all() -> None:
    found = Project.parse(project(IMAGE, FBS, elements={"X0": b"\x81\x20\xff\x98", "X1": b"ok"})).comments
    assert (found.code_page, found.sure) == ("latin-1", False)
    assert found.elements["X1"] == "ok"


def test_terminal_control_does_not_get_through() -> None:
    found = Project.parse(project(IMAGE, FBS, elements={"X0": b"a\x1b[2Jb\nc"}))
    assert found.comments.elements == {"X0": "a [2Jb c"}


def test_a_file_cut_anywhere() -> None:
    for end in [*range(0, 300, 7), *range(300, len(GOOD) - 4, 1777), *range(len(GOOD) - 40, len(GOOD) - 3)]:
        with pytest.raises(DataError):
            Project.parse(GOOD[:end])


def test_a_file_with_a_changed_byte_is_read_right_or_refused() -> None:
    noise = random.Random(7)  # noqa: S311  # a fixed seed
    for _ in range(150):
        place = noise.randrange(256, len(GOOD))
        broken = bytearray(GOOD)
        broken[place] ^= 1 << noise.randrange(8)
        try:
            found = Project.parse(bytes(broken))
        except DataError:
            continue
        assert fbs_code(words_of_image(found.memory.image)).words == (*CODE, *SUB)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "not a WinProladder project"),
        (b"PK\3\4" * 100, "not a WinProladder project"),
        (head() + struct.pack("<HH", 0xFFFF, 0), "expected one program image in the project, got 0"),
        (head(), "is incomplete"),
        (head() + record(0x180A, bytes(100)) + b"\xff\xff\0\0", "has 100 bytes"),
        (head() + record(0x1003, b"\2\0X0\2\0on\0\0", 1) + b"\xff\xff\0\0", "expected the sum 0001"),
        (head() + record(0x1800, bytes(0x400)) + b"\xff\xff\0\0", "has 1024 bytes"),
        (head() + bytes(4 << 20), "more than 200000 records"),
        (GOOD[:-4] + record(0x182A, bytes(16384)) + GOOD[-4:], "got 2"),
    ],
)
def test_files_that_are_none(data: bytes, message: str) -> None:
    with pytest.raises(DataError, match=message) as caught:
        Project.parse(data, "press.pdw")
    assert caught.value.message.startswith("press.pdw: ")
    assert caught.value.details["file"] == "press.pdw"


def test_records_without_the_two_bytes_behind() -> None:
    """Which types have them was seen for the common ones only."""
    key = key_of(5)
    records = [
        record(0x182A, enciphered(IMAGE.image[:16384], key))[:-2],
        record(0x1050, b"whatever")[:-2],
        record(0x1001, struct.pack("<HHH", 0x0200, 4, 0) + b"MAIN"),
    ]
    found = Project.parse(head() + b"".join(records) + b"\xff\xff\0\0\0\0")
    assert found.memory.image == IMAGE.image[:16384]
    assert found.comments.units == {0x0200: "MAIN"}
    assert found.memory.other is None


def fbe_image() -> bytes:
    words = [0xFFFF] * 16384
    words[0x1400 : 0x1400 + 10] = [*CODE, 0xACF5, 0xFFFF, 0x000A, 0xFFFF, 0x0040, 0x01C1]
    words[0x33FE] = 0xAA55
    return struct.pack("<16384H", *words)


FBE = head(b"FBE-40MA") + record(0x1800, enciphered(fbe_image(), key_of(1))) + b"\xff\xff\0\0"


def test_an_fbe_project() -> None:
    found = Project.parse(FBE)
    assert found.model == "FBE-40MA"
    assert found.memory.image == fbe_image()
    code = fbe_code(found.memory.image)
    assert [each.text for each in code.instructions][4:] == ["~FUN 08 MOV S:FFFFH D:R0", "ORG X0", "OUT Y1"]
    assert [2 * network.place for network in code.networks] == [0x2800, 0x2810]
