"""One of two processes on a line: opens it, asks for some registers, closes it, again and again.

::

    python turns.py TARGET EXCHANGES SEED

Prints what it saw as JSON. ``wrong`` counts values that are another register's.
"""

from __future__ import annotations

import json
import sys
from random import Random

from fatektool.connection import connect
from fatektool.errors import LineError
from fatektool.protocol.elements import Element
from fatektool.transport import lock

REGISTERS = 1000


def main(target: str, exchanges: int, seed: int) -> None:
    lock._POLL_S = 0.0002  # type: ignore[misc]  # a user's next try may come 50 ms later, a test's must not
    random = Random(seed)  # noqa: S311  # the same each time
    done = turns = wrong = trouble = 0
    while done < exchanges:
        turns += 1
        with connect(target, timeout_s=600, lock_wait_s=600) as plc:
            for _ in range(random.randrange(1, 40)):
                first = random.randrange(REGISTERS - 8)
                count = random.randrange(1, 8)
                try:
                    found = plc.read_registers(Element.parse(f"R{first}"), count)
                except LineError:
                    trouble += 1
                    break
                expected = tuple((address * 31 + 7) % 65536 for address in range(first, first + count))
                wrong += found != expected
                done += 1
            counters = plc.link.counters
            trouble += counters.trouble + counters.strays
    print(json.dumps({"exchanges": done, "turns": turns, "wrong": wrong, "trouble": trouble}))  # noqa: T201


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
