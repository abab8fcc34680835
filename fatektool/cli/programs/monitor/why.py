"""``monitor --why``: one element, one round."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.cli.programs.monitor.documents import why_document
from fatektool.cli.programs.monitor.words import WhyWords, program_words
from fatektool.jobs.monitor.same_program import SameProgram

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.jobs.monitor.why import Question
    from fatektool.project.program_file import ProgramFile


def explain(
    connection: Connection,
    voice: Voice,
    file: ProgramFile,
    question: Question,
    comments: Mapping[str, str],
) -> bool:
    """Say why an element is on or off; False if it could not be read."""
    with connection.open(voice) as plc:
        program = SameProgram(plc, file)
        program.compare(program.missing(question.networks))
        why = question.ask(plc)
        document = why_document(plc, why, program, comments)
    say_of_program(program, voice)
    voice.show(document, WhyWords(why, comments).lines())
    return why.value is not None


def say_of_program(program: SameProgram, voice: Voice) -> None:
    """A warning where the PLC's program is another, or was not compared as far as intended; else a detail."""
    if program.is_certain:
        voice.detail(program_words(program))
    else:
        voice.warn(program_words(program))
