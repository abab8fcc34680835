"""Restore a backup with a question of your own, and show what the errors say.

Usage: python restore_with_questions.py TARGET FILE
"""

from __future__ import annotations

import sys
from pathlib import Path

import fatektool


def agree(plan: fatektool.RestorePlan, copy: Path | None) -> bool:
    """Ask whatever must be asked on your machine; this one agrees to small changes alone."""
    print(f"{len(plan.pages)} pages to write; previous program saved in {copy}")
    return len(plan.comparison.pages) < 100


def main() -> int:
    """Restore, changed pages only, and write the previous program back if that fails."""
    target, file = sys.argv[1], Path(sys.argv[2])
    options = fatektool.RestoreOptions(stop=True, run=True, changed_only=True, rollback=True)
    with fatektool.connect(target) as plc:
        try:
            result = fatektool.restore(plc, fatektool.load_backup(file), file, confirm=agree, options=options)
        except fatektool.RestoreIncomplete as error:
            print(f"not complete: {error.details['pages_written']} hold the new program", file=sys.stderr)
            raise
    print(f"{result.pages_written} pages written, PLC in {result.mode_after.upper()}")
    return 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    try:
        sys.exit(main())
    except fatektool.FatektoolError as error:
        print(error, file=sys.stderr)
        sys.exit(error.exit_code)
