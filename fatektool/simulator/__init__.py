"""A simulated FATEK PLC with memory, to test a client without a PLC.

::

    listen    one thread; listeners on TCP, UDP, a pty    (none in the same process)
       │
    line      bytes and times in, bytes and times out    <── faults   injected errors, seeded
       │
    slaves    a protocol for a line: splits frames, answers requests
       ├── fatek               common to FACON and the M-series: commands, fields
       ├── facon, mseries      frames, and the notation of fields
       └── modbus              functions and the map; rtu, ascii, tcp: frames
       │
    plc       the operations of a PLC, as values; refusal: the errors
       ├── models, memory, elements, program
       └── state      its memory in a file

    build     builds all of it
    replay    replaces all from line to plc: the answers of a recorded PLC

It shares no code with the client: both were written from the papers, so a wrong interpretation in one shows
as a difference between the two. From ``line`` down there is no I/O, no clock and no thread, except the state
file.
"""
