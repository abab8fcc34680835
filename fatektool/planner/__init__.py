"""Elements wanted, to the requests with the least line time.

The cost of a plan is counted in bytes on the wire: those of each request and of its answer, and the PLC's
turnaround, in bytes at this baud. What each part costs is asked of the codec, so that one planner serves
every protocol.

::

    elements ─> lines of places ─> edges between places ─> the least path ─> requests ─> answers ─> values
                 atoms.py           edges.py                paths.py          reads.py, writes.py  atoms.py

A set of elements is divided into *atoms*: discretes, and registers of 16 bits. The atoms of one symbol are
on a line, the lines one behind the other, and a plan is a path over them:

- a **run** of registers (46, 47), of discretes (44, 45), or of discretes packed in words (46, 47), in a
  request of its own; a run of a read goes on over a gap where that costs less than another request;
- **mixed** items (48, 49): registers, pairs of them, discretes, packed words, of all lines together.

Where a protocol has no mixed requests, as Modbus, a plan has runs only; where it cannot lay a run over two
elements (``Codec.neighbourhood``), each side is planned for itself. What one request holds is the codec's
too.

An element of 32 bits or a packed word is within one run or item, so that its parts are of one scan
[E:one-scan], in reads and in writes; a write writes each atom once. Of all plans that keep to this, the
result is one that costs least: ``edges.py`` says why no other needs to be looked at, ``paths.py`` why the
least of them is found, and the tests compare it with every plan there is.
"""

from fatektool.planner.atoms import Values
from fatektool.planner.costs import turnaround_bytes
from fatektool.planner.reads import plan_reads, planned_reads
from fatektool.planner.writes import plan_writes

__all__ = ["Values", "plan_reads", "plan_writes", "planned_reads", "turnaround_bytes"]
