"""``listing``: a program in the vendor's mnemonics."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.programs.documents import listing_document
from fatektool.cli.programs.listing_view import ladder_lines, listing_lines
from fatektool.cli.programs.network_range import chosen
from fatektool.cli.programs.program_files import comments_beside, comments_options, program_file, warn_of_code
from fatektool.cli.shared.inventory_file import inventory_option
from fatektool.cli.shared.options import PATH, voice_options
from fatektool.cli.shared.pairs import apart
from fatektool.cli.shared.report import report_option, write_report
from fatektool.files.times import utc
from fatektool.project.program_file import NO_COMMENTS

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.shared.output import Voice


@click.command("listing", epilog="Example: fatektool listing press.pdw --network 0-9")
@click.argument("file", type=PATH)
@click.option(
    "--network", "wanted", multiple=True, metavar="N|N-M", help="Only these networks; repeat for more."
)
@click.option("--words", is_flag=True, help="Show the words in hex, without comments.")
@click.option("--ladder", is_flag=True, help="Draw the networks, as wide as the terminal.")
@comments_options
@inventory_option
@report_option
@voice_options
def listing_command(
    file: Path,
    voice: Voice,
    *,
    wanted: tuple[str, ...],
    words: bool,
    ladder: bool,
    comments: Path | None,
    encoding: str | None,
    inventory: Path | None,
    report: Path | None,
) -> None:
    """List the program in FILE, a backup or a WinProladder project, in the vendor's mnemonics. Needs no PLC.

    ~ marks a name that is not the vendor's own, ?? words that are not known, in hex. A project's comments are
    shown beside its elements; --words leaves them out, unless --comments names a project.

    --ladder draws each network, with the comments under the elements. A wire that ends with a number
    continues below at the same number.
    """
    apart("ladder", "words", "as_json", why="a drawing has no words; --report draws into a page")
    found = program_file(file, voice, encoding)
    texts = comments_beside(found, comments, inventory, voice, encoding)
    in_lines = NO_COMMENTS if words and comments is None else texts
    networks = chosen(found.networks, wanted)
    warn_of_code(found, voice)
    document = listing_document(found, networks, texts)
    if report is not None:
        from fatektool.report.listing import listing_report

        write_report(report, listing_report(document, networks, time=utc()))
    lines = ladder_lines(networks, texts) if ladder else listing_lines(networks, in_lines, words=words)
    voice.show(document, lines)
