"""The history of programs: a git repository with a file for each PLC and a commit for each change.

Any git can read it. No git is needed to write it: dulwich is git in Python. The repository is bare: there is
no work tree that a killed run could leave half written::

    NAME.json        the backup file, as 'backup' writes it; one page per line, which 'git log -p' shows
    commit           the program of one PLC changed; a new time, status or version alone is no change

Modules::

    history      record, log, show, export: the interface          checking     is anything damaged?
    recording    compare with the last backup, commit if changed   revisions    'a1b2c3d', '2026-11-22', '~1'
    repository   reading; the hash of each object is checked       messages     the text of a commit
    writing      the lock and the branch, safe against crashes     names        valid names of PLCs
    trees        the PLCs' files in a tree                         packing      many loose objects into a pack
    loose        an object as a file                               push         a copy in another repository
    commits      a commit as plain values
"""
