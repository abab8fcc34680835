"""Elements wanted, to the requests with the least line time.

The cost of a plan is counted in bytes on the wire: those of each request and of its answer, and the PLC's
turnaround, in bytes at this baud. What each part costs is asked of the codec, so that one planner serves
every protocol.

::

    elements ─> atoms on lines ─> edges between atoms ─> the least path ─> requests ─> answers ─> values
                 atoms.py          reads.py, writes.py     paths.py                     atoms.py

A set of elements falls into *atoms*: discretes, and registers of 16 bits. The atoms of one symbol lie on a
line, the lines one behind the other, and a plan is a path over them:

- a **run** of registers (46, 47), of discretes (44, 45), or of discretes packed in words (46, 47), in a
  request of its own; a run of a read goes on over a gap where that costs less than another request;
- **mixed** items (48, 49): registers, pairs of them, discretes, packed words, of all lines together.

The result is the least for this cost: ``paths.py`` says why. An element of 32 bits or a packed word is read
within one request, so that its parts are of one scan.
"""

from fatektool.planner.atoms import Values
from fatektool.planner.costs import turnaround_bytes
from fatektool.planner.reads import plan_reads
from fatektool.planner.writes import plan_writes

__all__ = ["Values", "plan_reads", "plan_writes", "turnaround_bytes"]
