"""The inventory: which PLCs there are, where they are, and what belongs to them. A TOML file.

::

    [defaults]                              # for all; everything but reference
    protocol = "facon"
    timeout_s = 1.0

    [plc.press]                             # a name: 'fatektool status -p press'
    target = "tcp://192.168.2.3"            # as for --port; the only key that must be there
    station = 1
    tags = ["hall-1", "night"]              # --select night
    spec = "press.toml"                     # what 'fleet snapshot' reads
    reference = "references/press.json"     # the program that ought to be in it: 'fleet verify', 'check'

::

    find      which file is the inventory         values   the value of each key
    load      an inventory, read from its file    lines    the line of each key
    entries   from TOML to PLCs and faults        select   the PLCs that --select names
    add       one more PLC at the end of the file

Paths are relative to the file's folder. There are no secrets in it, as these PLCs know none.
"""
