"""A simulated FATEK PLC with memory: to try a client out where there is no PLC.

::

    servers   one thread; doors, pty_door, pty_link      (or, in the same process, no server at all)
       │
    line      bytes and times in, bytes and times out    <── faults   what goes wrong, seeded
       │
    slave     what a line needs of a protocol; slaves names them all
       ├── facon_slave    ── facon_frame, facon_fields
       └── mseries_slave  ── mseries_frame, mseries_fields
       │
    plc       what a PLC does, in values; refusal says no
       ├── models, memory, elements, program_image
       └── state      its memory in a file

    build     puts all of it together
    replay    instead of all from line to plc: answers as a PLC did that was recorded

It shares no code with the client: both were written from the papers, so that a misreading of one shows
as a disagreement of the two. From ``line`` down there is no I/O, no clock and no thread, but for the
state file.
"""
