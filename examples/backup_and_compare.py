"""Back a PLC up and say what changed since the last backup.

Usage: python backup_and_compare.py TARGET FOLDER
"""

from __future__ import annotations

import sys
from pathlib import Path

import fatektool


def main() -> int:
    """Back up, compare with the newest backup in the folder, keep the new one if it differs."""
    target, folder = sys.argv[1], Path(sys.argv[2])
    with fatektool.connect(target) as plc:
        report = fatektool.read_status(plc)
        new = fatektool.backup(plc)
    print(
        f"{'RUN' if report.flags.running else 'STOP'}, {new.program.ladder_words} words, {new.program.sha256}"
    )

    older = sorted(folder.glob("*.json"))
    if older:
        change = fatektool.compare(fatektool.load_backup(older[-1]).program, new.program)
        if change.same:
            print(f"no change since {older[-1].name}")
            return 0
        print(f"changed since {older[-1].name}: {change.word_count} words, pages {change.page_numbers}")
    path = folder / f"{new.created.replace(':', '')}.json"
    fatektool.save_backup(new, path)
    print(f"kept as {path.name}")
    return 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    try:
        sys.exit(main())
    except fatektool.FatektoolError as error:
        print(error, file=sys.stderr)
        sys.exit(error.exit_code)
