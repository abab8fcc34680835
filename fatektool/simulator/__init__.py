"""A simulated FATEK PLC with memory: to try a client out where there is no PLC.

::

    listen    one thread; listeners on TCP, UDP, a pty    (or, in the same process, none at all)
       │
    line      bytes and times in, bytes and times out    <── faults   what goes wrong, seeded
       │
    slaves    what a line needs of a protocol: frames cut, requests answered
       ├── fatek               what FACON and the M-series share: commands, fields
       ├── facon, mseries      frames, and how fields are written
       └── modbus              functions and the map; rtu, ascii, tcp: frames
       │
    plc       what a PLC does, in values; refusal says no
       ├── models, memory, elements, program
       └── state      its memory in a file

    build     puts all of it together
    replay    instead of all from line to plc: answers as a PLC did that was recorded

It shares no code with the client: both were written from the papers, so that a misreading of one shows
as a disagreement of the two. From ``line`` down there is no I/O, no clock and no thread, but for the
state file.
"""
