"""What does the 8-bit checksum let through, and what do a second pass and parity? Counted, not estimated.

Usage: python bench/lrc.py [ANSWERS]
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))

from figures import figure

from tests.reliability.damage import DAMAGES, count

ANSWERS = 200_000
SEED = 1


def main() -> None:
    """Print a row a kind of damage."""
    answers = int(sys.argv[1]) if len(sys.argv) > 1 else ANSWERS
    for name, damage in DAMAGES.items():
        found = count(damage, answers, SEED)
        share = f"1 in {found.damaged / found.passed:.0f}" if found.passed else "none"
        figure(f"{name}: alike in two passes, of {found.damaged}", found.same_twice, "pages", 0)
        print(
            f"{name:<22} damaged {found.damaged:>8}  passed {found.passed:>6} ({share})  "
            f"both passes {found.passed_twice:>4}, alike {found.same_twice}  "
            f"not seen by parity {found.unseen_by_parity}"
        )


if __name__ == "__main__":
    main()
