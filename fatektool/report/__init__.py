"""Reports: a JSON document of a command as one self-contained HTML file.

::

    loopback.py  program.py  snapshot.py  series.py    the contents of each kind of report
    rounds.py                             the rounds of a series: numbers of all, points of some
    svg.py  scale.py  page_map.py         charts
    page.py  style.py                     the common parts of all reports
    markup.py                             the only conversion of text to HTML

All numbers are those of the document. Nothing here prints, reads a clock or opens a file: the same document
gives the same bytes.
"""
