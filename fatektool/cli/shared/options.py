"""The options that all commands share, and the types of their values."""

from __future__ import annotations

import os
from functools import wraps
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click

from fatektool import checks
from fatektool.cli.shared.output import Voice

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from click.shell_completion import CompletionItem

F = TypeVar("F", bound="Callable[..., Any]")

CONNECTION: Final = "Connection"
OUTPUT: Final = "Output"
"""Sections of the help; an option that is of none is a command's own."""


class ConnectionOption(click.Option):
    """An option that says which PLC is meant, and how it is asked."""

    section = CONNECTION


class OutputOption(click.Option):
    """An option that says what is printed."""

    section = OUTPUT


def section_of(parameter: click.Parameter) -> str:
    """The section of the help that an option is in."""
    if "--help" in parameter.opts:
        return OUTPUT
    return str(getattr(parameter, "section", "Options"))


class FilePath(click.Path):
    """A file or folder as a ``pathlib.Path``, which is loaded when one is given; it need not be there."""

    def coerce_path_result(self, value: str | os.PathLike[str]) -> Path:
        """Make one of what was given.

        Raises:
            UsageError: on Windows the name opens a device, or is no file's name.
        """
        from pathlib import Path

        from fatektool.files.portable_name import require_file_name

        name = standard(os.fspath(value))
        require_file_name(name)
        return Path(name)


PATH = FilePath()


def completing(name: str) -> Callable[..., list[CompletionItem]]:
    """A function of ``complete.py`` for an option's ``shell_complete``; it is loaded when a shell asks."""

    def complete(*arguments: Any) -> list[CompletionItem]:
        from fatektool.cli.shared import complete as functions

        found: list[CompletionItem] = getattr(functions, name)(*arguments)
        return found

    return complete


def is_standard(path: Path | None) -> bool:
    """True for ``-``, which is standard input or output."""
    return str(path) == "-"


def standard(name: str) -> str:
    """``-`` for the names that the system has for the standard streams."""
    return "-" if name in {"/dev/stdin", "/dev/stdout"} else name


class _Checked(click.ParamType):  # type: ignore[type-arg]  # a generic in the newest click only
    """A value that a check takes; click's own classes beside it say in the help what is expected."""

    check: checks.Check[Any]

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Read the value."""
        try:
            return self.check.parse(value) if isinstance(value, str) else self.check.take(value)
        except ValueError as error:
            self.fail(str(error), param, ctx)


class WholeNumberType(_Checked, click.IntRange):
    """A whole number, both ends included."""

    def __init__(self, least: int, most: int) -> None:
        super().__init__(least, most)
        self.check = checks.WholeNumber(least, most)


class SecondsType(_Checked, click.FloatRange):
    """A time in seconds, both ends included; ``above`` leaves the lower end out."""

    def __init__(self, least: float, most: float, *, above: bool = False) -> None:
        super().__init__(least, most, min_open=above)
        self.check = checks.Seconds(least, most, above=above)


class ChoiceType(_Checked, click.Choice):  # type: ignore[type-arg]  # as above
    """One of some words."""

    def __init__(self, words: Iterable[str]) -> None:
        self.check = checks.OneOf(words)
        super().__init__(self.check.words)


class CheckedType(_Checked):
    """What a check takes, whatever that is."""

    name = "value"

    def __init__(self, check: checks.Check[Any]) -> None:
        self.check = check


def type_of(check: checks.Check[Any]) -> click.ParamType:  # type: ignore[type-arg]  # as above
    """The type of an option whose value a check takes."""
    if type(check) is checks.WholeNumber:
        return WholeNumberType(check.least, check.most)
    if isinstance(check, checks.Seconds):
        return SecondsType(check.least, check.most, above=check.above)
    if isinstance(check, checks.YesNo):
        return click.BOOL
    if type(check) is checks.OneOf:
        return ChoiceType(check.words)
    return CheckedType(check)


class Several(click.ParamType):  # type: ignore[type-arg]  # as above
    """Values with commas between them, each read by a type of its own."""

    def __init__(self, each: click.ParamType) -> None:  # type: ignore[type-arg]
        self.name = each.name
        self._each = each

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Read each of them."""
        if isinstance(value, tuple):
            return value
        return tuple(self._each.convert(part.strip(), param, ctx) for part in value.split(","))


def deadline_option(default_s: float, words: str) -> Callable[[F], F]:
    """``--deadline``, after which a check or a turn ends; the command gets ``deadline``."""
    return click.option(
        "--deadline",
        type=SecondsType(0, 86400, above=True),
        default=default_s,
        show_default=True,
        metavar="S",
        help=words,
    )


def voice_options(function: F) -> F:
    """``--json``, ``-q``, ``-v``; the command gets ``voice``."""

    @click.option(
        "--json", "as_json", cls=OutputOption, is_flag=True, help="One JSON document on stdout, errors too."
    )
    @click.option(
        "-q", "--quiet", cls=OutputOption, is_flag=True, help="Nothing on stderr but warnings and errors."
    )
    @click.option("-v", "--verbose", cls=OutputOption, is_flag=True, help="More on stderr.")
    @wraps(function)
    def with_voice(*args: Any, as_json: bool, quiet: bool, verbose: bool, **rest: Any) -> Any:
        return function(*args, voice=Voice(as_json, quiet, verbose), **rest)

    return with_voice  # type: ignore[return-value]  # click's decorators hand back what they get


def yes_option(function: F) -> F:
    """``--yes``."""
    return click.option("--yes", is_flag=True, help="Do not ask.")(function)
