"""Fuzz every target, or those named, each in a process of its own, from its kept corpus.

What atheris finds worth looking at goes to ``--found FOLDER``, from where ``keep.py`` takes what the kept
corpus lacks. An input that breaks a promise is left as ``crash-TARGET-…`` in the present folder.

Usage: python fuzz/run.py [--seconds N] [--found FOLDER] [TARGET …]
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
CORPUS = HERE / "corpus"
MAX_BYTES = 2048
_MIB = 2048
_INPUT_S = 10


def targets() -> list[str]:
    """Every target has a kept corpus."""
    return sorted(folder.name for folder in CORPUS.iterdir() if folder.is_dir())


def fuzz(target: str, seconds: int, found: Path, crashes: Path) -> int:
    """Look for so long; give the process's exit code and print how many inputs were tried."""
    done = subprocess.run(
        [
            *(sys.executable, "-m", "fuzz.under_atheris", target),
            *(str(found), str(CORPUS / target)),
            f"-max_total_time={seconds}",
            f"-max_len={MAX_BYTES}",
            f"-rss_limit_mb={_MIB}",
            f"-timeout={_INPUT_S}",
            f"-artifact_prefix={crashes}/crash-{target}-",
            "-print_final_stats=1",
        ],
        cwd=HERE.parent,
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
    )
    printed = done.stdout + done.stderr
    tried = re.search(r"stat::number_of_executed_units: (\d+)", printed)
    reached = re.findall(r"cov: (\d+)", printed)
    count = int(tried[1]) if tried else 0
    state = "ok" if done.returncode == 0 else "BROKEN"
    print(f"{target:<16} {count:>10} inputs in {seconds} s, {reached[-1] if reached else 0} places  {state}")
    if done.returncode or not count:
        print(printed[-4000:])
        return done.returncode or 1
    return 0


def main() -> int:
    """Fuzz; exit 1 if a promise broke."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seconds", type=int, default=5, help="of each target (default: 5)")
    parser.add_argument("--found", type=Path, metavar="FOLDER", help="keep what reaches new code there")
    parser.add_argument("target", nargs="*", help=f"of {', '.join(targets())} (default: all)")
    options = parser.parse_args()
    if importlib.util.find_spec("atheris") is None:
        print("atheris is not installed: expected python3 -m pip install -e '.[fuzz]'", file=sys.stderr)
        return 2
    unknown = sorted(set(options.target) - set(targets()))
    if unknown:
        print(f"no target {', '.join(unknown)}: expected {', '.join(targets())}", file=sys.stderr)
        return 2
    broken = 0
    with tempfile.TemporaryDirectory() as folder:
        for target in options.target or targets():
            found = (options.found or Path(folder)).resolve() / target
            found.mkdir(parents=True, exist_ok=True)
            broken |= fuzz(target, options.seconds, found, Path(os.curdir).resolve())
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
