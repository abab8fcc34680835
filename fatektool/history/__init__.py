"""The history of many PLCs' programs: a git repository with a file a PLC, and a commit for each change.

Any git reads it, and none is needed: dulwich is git in Python. The repository is bare, so that there is no
work tree to go astray, and nothing for a killed run to leave half written::

    NAME.json        the backup file, as 'backup' writes it; one page a line, so that 'git log -p' shows pages
    commit           one PLC's program changed; a new time, status or version alone is no change

Who looks for what::

    history      record, log, show, export: what a caller uses     checking     is all of it whole?
    recording    is it another program? Then a commit              revisions    'a1b2c3d', '2026-11-22', '~1'
    repository   reading, every object proven by its hash          messages     who and what, in words
    writing      the lock and the branch, in an order that holds   names        what a PLC may be called
    trees        the PLCs' files in a tree                         packing      many small files into one
    loose        an object as a file                               push         a copy in another repository
    commits      a commit in values
"""
