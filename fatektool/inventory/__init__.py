"""The inventory: a TOML file with the names, targets and settings of the PLCs.

::

    [defaults]                              # for all PLCs; any key but reference and project
    protocol = "facon"
    timeout_s = 1.0

    [plc.press]                             # the name: 'fatektool status -p press'
    target = "tcp://192.168.2.3"            # as for --port; the only required key
    station = 1
    tags = ["hall-1", "night"]              # --select night
    spec = "press.toml"                     # what 'fleet snapshot' reads
    reference = "references/press.json"     # the expected program: 'fleet verify', 'check'

::

    find      which file is the inventory         values   checks of the values of keys
    load      an inventory, read from its file    lines    the line of each key
    entries   from TOML to PLCs and faults        select   the PLCs that --select names
    add       one more PLC at the end of the file

Paths are relative to the folder of the file. It has no passwords: these PLCs have none.
"""
