"""Plans of requests: the elements to read or write, with the least line time.

The cost of a plan is counted in bytes on the wire: those of each request and of its answer, and the PLC's
turnaround, in bytes at this baud. The codec has the costs of each part, so one planner is used for all
protocols.

::

    elements ─> lines of places ─> edges between places ─> the least path ─> requests ─> answers ─> values
                 atoms.py           edges.py                paths.py          reads.py, writes.py  atoms.py

A set of elements is divided into *atoms*: discretes, and registers of 16 bits. The atoms of one symbol are on
a line, the lines are in sequence, and a plan is a path over them:

- a **run** of registers (46, 47), of discretes (44, 45), or of discretes packed in words (46, 47), in its own
  request; a run of a read includes a gap if that costs less than another request;
- **mixed** items (48, 49): registers, pairs of them, discretes, packed words, of all lines together.

If a protocol has no mixed requests, like Modbus, a plan has only runs; if two elements cannot be in one run
(``Codec.neighbourhood``), they are planned separately. The limits of a request are those of the codec.

An element of 32 bits or a packed word is within one run or item, so that its parts are from one scan
[E:one-scan], in reads and in writes; a write writes each atom once. The result has the least cost of all
plans with these properties: ``edges.py`` explains why other plans need not be examined, ``paths.py`` why the
least cost is found, and the tests compare it with all possible plans.
"""

from fatektool.planner.atoms import Values
from fatektool.planner.costs import turnaround_bytes
from fatektool.planner.reads import plan_reads, planned_reads
from fatektool.planner.writes import plan_writes

__all__ = ["Values", "plan_reads", "plan_writes", "planned_reads", "turnaround_bytes"]
