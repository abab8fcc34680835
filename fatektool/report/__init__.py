"""Reports that one can look at: a JSON document of a command as one self-contained HTML file.

::

    loopback.py  program.py  snapshot.py  series.py    what a report of each kind says
    rounds.py                             the rounds of a series: figures of all, points of some
    svg.py  scale.py  page_map.py         charts
    page.py  style.py                     the frame of every report
    markup.py                             the one place where text becomes HTML

The figures are the document's. Nothing here prints, reads a clock or opens a file: the same document gives
the same bytes.
"""
