"""Every command with and without --json: the same exit code, one document that its schema holds for."""

from __future__ import annotations

import json
import re

import pytest
from jsonschema import Draft202012Validator, ValidationError

from fatektool.cli.tools.schema import schema_names
from tests.cli.cases import CASES, Case
from tests.cli.running import NEW, OLD, Cli, Done, Press, check, one_line, schema_text, served
from tests.program.samples import backup, changed, header, program

DAMAGED = "damaged.json"


@pytest.fixture(params=CASES.values(), ids=list(CASES))
def case(request: pytest.FixtureRequest, press: Press) -> Case:
    found: Case = request.param
    if found.flags:
        press.set(*found.flags.split())
    press.file("large.json", program(500))
    press.file("odd.json", program(400, page0=header(400, b"XB30")))
    text = backup(OLD).to_bytes().decode()
    (press.folder / DAMAGED).write_text(text.replace(OLD.pages[3].hex().upper(), "AB"))
    return found


def error_line(case: Case, done: Done) -> str:
    """The one line of an error; a restore has told its plan before."""
    return one_line(done.err.splitlines()[-1] if "verified" in case.message else done.err)


@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
def test_what_a_command_answers(case: Case, press: Press, cli: Cli, *, as_json: bool) -> None:
    words = case.words.replace("PLC", press.target).replace("LONG", "z" * 400).split()
    before = press.program
    done = cli(*words, *(["--json"] if as_json else []))
    assert done.code == case.code, done
    if as_json:
        document = done.document(case.schema)
        if case.schema == "error":
            assert document["error"]["exit_code"] == case.code
            said = f"fatektool: {document['error']['message']}; {document['error']['hint']}"
            assert " ".join(said.split()).startswith(error_line(case, done))
    elif case.schema == "error":
        assert done.out == ""
    else:
        assert done.out
    if case.schema == "error":
        assert re.search(case.message, error_line(case, done)), done.err
        if "verified" not in case.message:
            assert press.program == before
    assert not list(press.folder.glob(".fatektool*"))


@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
@pytest.mark.parametrize(
    "fault",
    [
        (KeyboardInterrupt(), 130, "interrupted", "interrupted"),
        (
            ZeroDivisionError("two\nlines"),
            70,
            "fatektool_error",
            "a fault of fatektool itself: ZeroDivisionError: two lines; please report it",
        ),
    ],
)
def test_what_no_command_should_do(
    press: Press,
    cli: Cli,
    monkeypatch: pytest.MonkeyPatch,
    fault: tuple[BaseException, int, str, str],
    *,
    as_json: bool,
) -> None:
    raised, code, kind, message = fault

    def fail(*_: object, **__: object) -> None:
        raise raised

    monkeypatch.setattr("fatektool.jobs.programs.backup.read_proven", fail)
    done = cli("backup", "x.json", "-p", press.target, *(["--json"] if as_json else []))
    assert done.code == code
    assert one_line(done.err).startswith(f"fatektool: {message}")
    if as_json:
        assert done.document("error")["error"]["kind"] == kind
    assert not (press.folder / "x.json").exists()


def test_a_fault_can_be_looked_into(press: Press, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object, **__: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("fatektool.jobs.programs.backup.read_proven", fail)
    monkeypatch.setenv("FATEKTOOL_TRACEBACK", "1")
    with pytest.raises(ZeroDivisionError):
        cli("backup", "x.json", "-p", press.target)


@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
def test_a_restore_that_does_not_complete(press: Press, cli: Cli, *, as_json: bool) -> None:
    with served(faults=["power-cut=4"]) as door:
        words = ["--timeout", "60", "--retries", "0", "--yes", *(["--json"] if as_json else [])]
        done = cli("restore", press.new, "-p", door.target, *words)
        assert done.code == 6
        (safety,) = press.safety
        again = f"fatektool restore --changed-only {press.new} -p {door.target} {' '.join(words)}"
        lines = done.err.splitlines()
        *_, pages_new, pages_in_doubt, pages_old, saved, fix, command = lines
        said = lines[lines.index("fatektool: the restore did not complete") + 1 :]
        assert said[0] == f"  PLC               station 1 on {door.target}"
        assert said[1] == "  mode              not known: do not switch it to RUN; STOP it if it runs"
        assert said[2].startswith("  cause             ")
        assert pages_new == "  page 0-2          written but not read back"
        assert pages_in_doubt == "  page 3            uncertain"
        assert pages_old == "  page 4-7          the previous program"
        assert saved == f"  previous program  saved in {safety}"
        assert fix == "fix the cause, then run:"
        assert command == again
        if as_json:
            details = done.document("error")["error"]["details"]
            assert details["pages_written"] == [0, 1, 2]
            assert details["pages_uncertain"] == [3]
            assert details["pages_old"] == [4, 5, 6, 7]
            assert details["mode"] is None
            assert details["safety_backup"] == str(safety)
            assert details["command"] == again
        else:
            assert done.out == ""
        door.simulation.power_on()
        finished = cli(*again.split()[1:])
        assert finished.code == 0
        assert door.pages == NEW.pages
        assert press.safety == [safety]


def test_the_command_to_go_on_keeps_every_option(
    press: Press, cli: Cli, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without them the second run would look elsewhere for the way back, or refuse the header."""
    odd = press.file("odd one.json", program(400, page0=header(400, b"XB30")))
    (press.folder / "kept").mkdir()
    with served(faults=["power-cut=1"]) as door:
        monkeypatch.setenv("FATEKTOOL_PORT", door.target)
        done = cli("restore", odd, "--any-header", "--safety-dir", "kept", "--retries", "0", "--changed-only",
                   "--timeout", "60", "--yes")  # fmt: skip
        assert done.code == 6
        assert done.err.rstrip().endswith(
            f"fatektool restore --changed-only -p {door.target} '{odd}' --any-header --safety-dir kept "
            f"--retries 0 --timeout 60 --yes"
        )


def test_an_answer_of_a_program_that_keeps_itself(press: Press, cli: Cli) -> None:
    with served(program_commands=False) as door:
        done = cli("backup", "x.json", "-p", door.target)
        assert done.code == 4
        assert "refused to read program page 0 (4F): error 4" in one_line(done.err)
        assert "a password may be set; use the engineer's project file" in done.err
        assert not (press.folder / "x.json").exists()


# --- schemas --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", schema_names())
def test_every_schema_is_one_and_is_printed(cli: Cli, name: str) -> None:
    schema = json.loads(schema_text(name))
    Draft202012Validator.check_schema(schema)
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    for words in (["schema", name], ["schema", f"fatektool.{name}/1"], ["schema", name, "--json"]):
        done = cli(*words)
        assert done.code == 0
        assert json.loads(done.out) == schema


def test_every_document_of_the_cases_has_a_schema(cli: Cli) -> None:
    assert cli("schema").out.split() == schema_names()
    assert {case.schema for case in CASES.values()} <= set(schema_names())


def test_a_document_that_does_not_hold_is_noticed() -> None:
    """The check itself: a schema that lets everything pass would prove nothing."""
    with pytest.raises(ValidationError, match="is a required property"):
        check({"schema": "fatektool.mode/1"}, "mode")
    with pytest.raises(AssertionError):
        check({"schema": "fatektool.status/1"}, "mode")


def test_a_change_by_one_word_is_shown_with_its_page(press: Press, cli: Cli) -> None:
    one = press.file("one.json", changed(OLD, 5))
    before, after = OLD.pages[5][64:66].hex().upper(), changed(OLD, 5).pages[5][64:66].hex().upper()
    assert cli("diff", press.old, one).out.splitlines()[1:] == ["page 5"]
    assert cli("diff", press.old, one, "-v").out.splitlines()[1:] == [
        "page 5", "page 5, 1 word: 32", f"   32: {before} -> {after}"
    ]  # fmt: skip
    assert f"\n   32: {after} -> {before}\n" in cli("verify", one, "-p", press.target, "-v").out
    assert "differs: 1 word in 1 page (" in cli("diff", press.old, one).out
    difference = cli("diff", press.old, one, "--json").document("diff")["differences"]
    assert difference == [{"page": 5, "words": [{"word": 32, "a": before, "b": after}]}]
