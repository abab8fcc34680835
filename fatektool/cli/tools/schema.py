"""``schema``: the JSON Schema of each document."""

from __future__ import annotations

import json
from importlib.resources import files
from typing import Any

import click

from fatektool.cli.shared.options import completing, voice_options
from fatektool.cli.shared.output import Voice, print_json
from fatektool.cli.tools.documents import schemas_document
from fatektool.errors import UsageError


@click.command("schema", epilog="Example: fatektool schema backup")
@click.argument("name", required=False, shell_complete=completing("complete_schema"))
@voice_options
def schema_command(name: str | None, voice: Voice) -> None:
    """Print the JSON Schema of the document NAME; without NAME list the names."""
    known = schema_names()
    if name is None:
        voice.show(schemas_document(known), known)
        return
    short = name.removeprefix("fatektool.").partition("/")[0]
    if short not in known:
        raise UsageError(f"no document {name!r}: expected one of {', '.join(known)}")
    print_json(load_schema(short))


def schema_names() -> list[str]:
    """The documents that have a schema: all of them."""
    folder = files("fatektool") / "schemas"
    return sorted(
        entry.name.removesuffix(".json") for entry in folder.iterdir() if entry.name.endswith(".json")
    )


def load_schema(name: str) -> dict[str, Any]:
    """One schema."""
    text = (files("fatektool") / "schemas" / f"{name}.json").read_text(encoding="utf-8")
    schema: dict[str, Any] = json.loads(text)
    return schema
