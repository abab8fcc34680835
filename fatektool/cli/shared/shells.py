"""Shells beside those of click: fish with whole descriptions, and PowerShell."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, ClassVar

from click.shell_completion import FishComplete, ShellComplete, add_completion_class

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

SHELLS = ("bash", "zsh", "fish", "powershell")

_POWERSHELL = """\
Register-ArgumentCompleter -Native -CommandName %(prog_name)s -ScriptBlock {
    param($wordToComplete, $commandAst, $cursorPosition)
    $words = $commandAst.CommandElements | Where-Object { $_.Extent.StartOffset -lt $cursorPosition }
    $env:COMP_WORDS = ($words | ForEach-Object { $_.ToString() }) -join "`n"
    $env:COMP_CWORD = $wordToComplete
    $env:%(complete_var)s = "powershell_complete"
    try {
        %(prog_name)s | ForEach-Object {
            $value, $words = $_ -split "`t", 2
            [System.Management.Automation.CompletionResult]::new($value, $value, "ParameterValue", $words)
        }
    } finally {
        Remove-Item Env:COMP_WORDS, Env:COMP_CWORD, Env:%(complete_var)s -ErrorAction SilentlyContinue
    }
}
"""


class WholeFishComplete(FishComplete):
    """fish, whose descriptions go past the first comma."""

    name = "fish"
    source_template = FishComplete.source_template.replace('string split ","', 'string split -m 1 ","')

    def format_completion(self, item: CompletionItem) -> str:
        """A value with its description, on one line."""
        return super().format_completion(_on_one_line(item))


class PowerShellComplete(ShellComplete):
    """PowerShell: a line for each value with its description; files it completes itself."""

    name = "powershell"
    source_template: ClassVar[str] = _POWERSHELL

    def get_completion_args(self) -> tuple[list[str], str]:
        """The words before the one that is completed, and that one.

        PowerShell removes a variable that it sets to an empty text: no word is begun then.
        """
        words = os.environ.get("COMP_WORDS", "").split("\n")[1:]
        incomplete = os.environ.get("COMP_CWORD", "")
        if incomplete and words and words[-1] == incomplete:
            words.pop()
        return words, incomplete

    def format_completion(self, item: CompletionItem) -> str:
        """Value, tab, description; PowerShell takes no empty one."""
        return f"{item.value}\t{_on_one_line(item).help or item.value}"

    def complete(self) -> str:
        """All values but files."""
        found = self.get_completions(*self.get_completion_args())
        return "\n".join(self.format_completion(item) for item in found if item.type == "plain")


def _on_one_line(item: CompletionItem) -> CompletionItem:
    if item.help:
        item.help = " ".join(item.help.split())
    return item


def add_shells() -> None:
    """Make them known to click."""
    add_completion_class(WholeFishComplete)
    add_completion_class(PowerShellComplete)
