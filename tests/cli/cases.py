"""Command lines and what they answer, as a table.

A line is exit code, schema of the document, and the command; in brackets stand flags that the PLC has. For
errors the line below tells what the message says, as a pattern. PLC is a PLC of 400 words in STOP with the
program of old.json.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

ANSWERS = """\
0 status: status -p PLC
0 status: status -p PLC --brief
0 status: status -p PLC [running battery_low ladder_checksum_error rom_pack watchdog id_set emergency_stop]
0 backup-result: backup x.json -p PLC
0 backup-result: backup -p PLC
0 backup-result: backup x.json -p PLC --single-pass --raw x.bin
0 verify: verify old.json -p PLC
1 verify: verify new.json -p PLC
1 verify: verify large.json -p PLC
0 restore: restore new.json -p PLC --yes
0 restore: restore old.json -p PLC
0 restore: restore new.json -p PLC --dry-run
0 restore: restore new.json -p PLC --dry-run --stop [running]
0 restore: restore new.json -p PLC --stop --run --yes [running id_set]
0 restore: restore new.json -p PLC --no-safety-backup --yes
0 inspect: inspect old.json
0 inspect: inspect odd.json --raw x.bin
0 diff: diff old.json old.json
1 diff: diff old.json new.json
1 diff: diff old.json large.json
0 mode: run -p PLC --yes
0 mode: run -p PLC [running]
0 mode: stop -p PLC --yes [running]
0 mode: stop -p PLC
0 broadcast: run -p PLC -s 0 --broadcast --yes
0 loopback: loopback -p PLC --count 24
0 loopback: loopback -p PLC --duration 0.01 --sizes 0,256 --pattern random --seed 7 --max-p99 1000
1 loopback: loopback -p PLC -s 9 --count 2 --timeout 0.01
1 loopback: loopback -p PLC --raw 02,03 --count 2 --timeout 0.01
0 doctor: doctor -p PLC
1 doctor: doctor -p PLC [battery_low]
1 doctor: doctor -p PLC -s 9 --timeout 0.01
0 scan: scan -p PLC --stations 1-3,7 --timeout 0.01
0 ports: ports
0 link-ports: link ports -p PLC
0 link-result: link result R0 -p PLC
0 link-table: link table show R0 --kind md0 -p PLC
1 link-table: link table show R0 --kind mbus --check -p PLC
0 decode: decode 02 30 31 34 30 43 37 03
0 encode: encode 46 R12 3
0 schemas: schema
"""

ERRORS = r"""
2 status -p PLC --zzzz
    No such option:? '?--zzzz'?; see 'fatektool status --help'
2 sttus
    no such command 'sttus'; did you mean status
2 schema nope
    no document 'nope': expected one of .*backup,
2 status
    no PLC named; give --port, .*FATEKTOOL_PORT
2 status -p PLC -s 0
    station: expected 1 to 254, got 0; 0 is a broadcast
2 status -p PLC -s 255
    station: expected 1 to 254, got 255; facon has no others
2 status -p PLC -s x
    '--station': expected a whole number from 1 to 254, .*, got 'x'
2 status -p PLC --baud 49
    '--baud': expected a whole number from 50 to 4000000, got 49
2 status -p PLC --format 9X3
    '--format': expected data bits, parity and stop bits such as 7E1 or 8N1, got '9X3'
2 status -p PLC --timeout 0
    '--timeout': expected seconds above 0, up to 86400, got 0
2 status -p PLC --timeout nan
    '--timeout': expected seconds above 0, up to 86400, got nan
2 status -p PLC --lock-wait nan
    '--lock-wait': expected seconds from 0 to 86400, got nan
2 status -p PLC --lock-wait inf
    expected seconds from 0 to 86400, got inf
2 status -p PLC --retries -1
    '--retries': expected a whole number from 0 to 1000, got -1
2 status -p PLC --protocol x
    '--protocol': expected one of facon, .*, got 'x'
2 status -p socket://127.0.0.1
    socket://127.0.0.1: expected socket://HOST:PORT
2 status -p rfc2217://127.0.0.1:no
    expected rfc2217://HOST:PORT
2 status -p spy://
    expected spy://PORT
2 status -p hwgrep://(
    invalid search
2 status -p loop://?x
    invalid options
2 read R0 -p /dev/ttyS0 --protocol modbus-tcp
    protocol modbus-tcp is for networks
2 status -p tcp://
    expected tcp://host:port
2 status -p PLC --trace x.txt
    ends in .pcap or .ndjson
2 status -p PLC --trace no/x.pcap
    no is not a folder; create it first
2 backup old.json -p PLC
    exists already and is kept; .*--force
2 backup x.json --raw old.json -p PLC
    old.json exists already
2 backup x --raw ./x -p PLC
    x is named twice
2 backup x --raw - -p PLC
    expected a file name
2 backup no/x -p PLC
    no is not a folder; create it first
2 backup /dev/null --force -p PLC
    is a device, expected a file name
2 inspect old.json --raw old.json --force
    named twice
2 inspect no.json
    cannot read no.json: No such file
2 inspect
    Missing argument 'FILE'; see 'fatektool inspect --help'
2 inspect old.json new.json
    unexpected extra argument
2 restore new.json -p PLC
    no terminal to ask on: nothing was written; add --yes
2 restore new.json -p PLC --rollback --no-safety-backup
    does not go with
2 restore new.json -p PLC --safety-dir old.json --yes
    old.json is not a folder
2 restore old.json --run -p PLC
    add --yes
2 run -p PLC
    no terminal to ask on: nothing was done; add --yes
2 stop -p PLC [running]
    add --yes
2 stop -p PLC -s 0 --broadcast
    add --yes
2 stop -p PLC -s 0 --yes
    0 is broadcast, to which no PLC replies: add --broadcast
2 stop -p PLC --broadcast --yes
    expected station 0, got 1; add -s 0
2 status -p PLC -s 0 --broadcast
    No such option
2 run -p PLC --yes --read-only
    'fatektool run' writes: this line is read-only, and nothing was sent
2 decode hello
    'hello' is neither hex digits in pairs nor an existing
2 decode LONG
    neither hex
2 loopback -p PLC --sizes 257
    loopback sizes: expected 0 to 256 characters, got 257
2 loopback -p PLC --raw 02,03 --sizes 510
    loopback sizes: expected 0 to 509 characters, got 510
2 loopback -p PLC --raw none,none --sizes 0
    loopback sizes: expected 1 to 511 characters, got 0
2 loopback -p PLC --raw 02
    raw frame '02': expected START,END as bytes in hex, such as 02,03
2 loopback -p PLC --sizes 1,x
    'x' is not a valid integer
2 loopback -p PLC --pattern zeros
    'zeros' is not one of 'ramp', 'random', 'alternate', 'ones'
2 loopback -p PLC --max-error-rate 2
    2.0 is not in the range
2 loopback -p PLC --count 0
    0 is not in the range
2 scan -p PLC --stations 0-3
    station 0: expected stations from 1 to 254; it is a unit of modbus-tcp
2 scan -p PLC --stations 9-3
    expected the lower station first
2 scan -p PLC --bauds 9600,19200
    has no baud rate and format: expected a serial port
2 scan -p PLC --bauds 10
    expected a whole number from 50 to 4000000, got 10
2 scan -p PLC --protocols nope
    '--protocols': expected one of facon, .*, got 'nope'
3 loopback -p /dev/nope
    /dev/nope: no such port
3 scan -p /dev/nope
    /dev/nope: no such port
3 doctor -p /dev/nope
    /dev/nope: no such port
3 status -p /dev/nope
    /dev/nope: no such port; check that the adapter is plugged in; 'fatektool ports'
3 status -p tcp://127.0.0.1:1
    cannot connect to 127.0.0.1 port 1
3 status -p tcp://plc.invalid
    plc.invalid: no such host
3 status -p PLC -s 9
    no answer from station 9 .*in 1 try and 4 other requests, 2.6 s in total:
4 restore new.json -p PLC --yes [running]
    make the machine safe, then add --stop
4 restore new.json -p PLC --dry-run [running]
    add --stop
4 restore new.json -p PLC --yes --stop [running rom_pack]
    take the ROM pack out
4 run -p PLC --yes [id_differs]
    error 6, cannot run, the PLC's ID differs
4 run -p PLC --yes [syntax_error]
    error 7.*restore a backup that ran
4 run -p PLC --yes [unsupported_instruction]
    error 9.*fatektool status
4 run -p PLC --yes [ladder_checksum_error]
    error 5.*restore a good backup
4 restore new.json -p PLC --run --yes [id_differs]
    read back and verified, but the PLC does not RUN
5 inspect damaged.json
    damaged.json: page 3: expected 256 hex digits
5 verify damaged.json -p PLC
    use another backup
5 diff old.json damaged.json
    damaged.json: page 3
5 restore damaged.json -p PLC --yes
    damaged.json: page 3
5 inspect plc.state
    expected schema 'fatektool.backup/1', got 'fatektool.simulator/1'
5 restore large.json -p PLC --yes
    expected a ladder size of 400 words, got 500
5 restore odd.json -p PLC --yes
    invalid header of the program .*: byte 0: .*--any-header
5 decode 0011223344
    expected bytes from STX .02. to ETX .03.
5 decode old.json
    line 1: not a trace record
5 status -p sim:old.json
    old.json:
"""


@dataclass(frozen=True)
class Case:
    """A command line, what it answers, and the state it is given in."""

    code: int
    schema: str
    words: str
    flags: str = ""
    message: str = ""


def _cases() -> dict[str, Case]:
    found = {}
    for code, schema, words, flags in re.findall(r"(\d) ([\w-]+): ([^\[\n]+)(?:\[(.*)\])?", ANSWERS):
        found[f"{words.strip()} {flags}"] = Case(int(code), schema, words.strip(), flags)
    for code, words, flags, message in re.findall(r"(\d) ([^\[\n]+)(?:\[(.*)\])?\n    (.+)", ERRORS):
        found[f"{words.strip()} {flags}"] = Case(int(code), "error", words.strip(), flags, message)
    return found


CASES = _cases()
