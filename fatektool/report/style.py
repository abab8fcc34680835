"""The style sheet of every report: light, dark, on paper, in a narrow window.

Each scheme is a set of colours; everything else uses their names. The meaning of a colour is also shown by a
mark, a word or a pattern. The contrast of text is 4.5 to 1 or more, that of lines 3 to 1 (WCAG 2.2, AA).
Paper is always light, and nothing on it depends on a background, because printers omit backgrounds.
"""

from __future__ import annotations

import base64
import hashlib
from typing import Final

LIGHT: Final = {
    "paper": "#ffffff",
    "ink": "#1b1f24",
    "quiet": "#535b66",
    "rule": "#c8ced6",
    "line": "#0b5cad",
    "good": "#17662e",
    "bad": "#a3210f",
    "ground": "#ffe2a0",
}
DARK: Final = {
    "paper": "#15181c",
    "ink": "#e7eaee",
    "quiet": "#a9b2bd",
    "rule": "#434b55",
    "line": "#79b7ff",
    "good": "#74d190",
    "bad": "#ff9686",
    "ground": "#5c4500",
}


def _colours(scheme: dict[str, str]) -> str:
    return "".join(f"--{name}:{colour};" for name, colour in scheme.items())


_SHEET: Final = """
*{box-sizing:border-box}
html{background:var(--paper);color:var(--ink);
 font:16px/1.5 system-ui,"Segoe UI",Roboto,"DejaVu Sans",sans-serif}
body{margin:0 auto;max-width:70rem;padding:1rem 1.25rem 3rem}
a{color:var(--line)}
.skip{position:absolute;left:-99rem}
.skip:focus{position:static}
.hidden{position:absolute;width:1px;height:1px;overflow:hidden;clip-path:inset(50%);white-space:nowrap}
h1{font-size:1.75rem;line-height:1.2;margin:.5rem 0 .25rem}
h2{font-size:1.25rem;margin:2.25rem 0 .75rem;padding-bottom:.25rem;border-bottom:1px solid var(--rule)}
h3{font-size:1.05rem;margin:1.5rem 0 .5rem}
h1,h2,h3,p,dd,th,td,li,summary,figcaption{overflow-wrap:anywhere}
p{max-width:48rem;margin:.5rem 0}
.what{color:var(--quiet);margin:0 0 1rem}
.verdict{border:1px solid var(--rule);border-left:.5rem solid var(--quiet);padding:.6rem 1rem;max-width:none;
 font-size:1.1rem;margin:1rem 0}
.verdict strong{margin-right:.5rem}
.verdict.good{border-left-color:var(--good)}
.verdict.good strong{color:var(--good)}
.verdict.bad{border-left:.5rem double var(--bad)}
.verdict.bad strong{color:var(--bad)}
.note{border-left:.25rem solid var(--rule);padding-left:.75rem;color:var(--quiet)}
dl{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,13rem),1fr));gap:.75rem 1.5rem;
 margin:1rem 0}
dl .long{grid-column:1/-1}
dt{color:var(--quiet);font-size:.875rem}
dd{margin:0;font-weight:600}
code,.hex td,.hex th{font-family:ui-monospace,"SFMono-Regular",Consolas,"DejaVu Sans Mono",monospace}
code{font-weight:400;font-size:.875rem;overflow-wrap:anywhere}
table{border-collapse:collapse;margin:.5rem 0 1rem;font-size:.9375rem}
caption{text-align:left;color:var(--quiet);font-size:.875rem;padding:.25rem 0}
th,td{border-bottom:1px solid var(--rule);padding:.25rem .75rem .25rem 0;text-align:left;vertical-align:top;
 unicode-bidi:isolate}
th:last-child,td:last-child{padding-right:0}
thead th{border-bottom-width:2px;color:var(--quiet);font-weight:600;vertical-align:bottom;
 overflow-wrap:normal}
tbody th{font-weight:600;min-width:6rem}
td{min-width:3rem}
tbody .n{white-space:nowrap;min-width:0}
.n{text-align:right;font-variant-numeric:tabular-nums}
.scroll{overflow-x:auto}
.scroll tbody th:not(.n){min-width:8rem}
.scroll .text{display:inline-block;min-width:14rem}
td time,th time{white-space:nowrap}
.sides{display:flex;flex-wrap:wrap;gap:0 2rem}
.hex table,.sides p{margin-bottom:.5rem}
.hex td,.hex tbody th,.hex thead th{padding:.1rem .3rem;font-size:.8125rem;border-bottom:0;min-width:0}
.hex tbody th,.hex thead th{color:var(--quiet);font-weight:400;text-align:right}
.hex thead th{border-bottom:1px solid var(--rule);text-align:center}
mark{background:var(--ground);color:var(--ink);font-weight:700;
 text-decoration:underline;text-underline-offset:.15em}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,24rem),1fr));gap:1rem 2rem;
 align-items:start}
figure{margin:.5rem 0 1rem;max-width:44rem;min-width:0}
figcaption{font-weight:600}
summary{cursor:pointer;color:var(--line);font-size:.875rem;padding:.25rem 0}
svg{display:block;width:100%;height:auto;overflow:visible}
svg text{fill:var(--quiet);font-size:12px;font-family:inherit}
svg .strong{fill:var(--ink);paint-order:stroke;stroke:var(--paper);stroke-width:3px;stroke-linejoin:round}
.grid{stroke:var(--rule);stroke-width:1;fill:none}
.axis{stroke:var(--quiet);stroke-width:1;fill:none}
.series{stroke:var(--line);stroke-width:1.75;fill:none;stroke-linejoin:round;stroke-linecap:round}
.dots{stroke:var(--line);stroke-width:5;fill:none;stroke-linecap:round}
.bar{fill:var(--line)}
.under{fill:var(--line);fill-opacity:.25;stroke:none}
.gap{stroke:var(--bad);stroke-width:1;fill:none}
.limit{stroke:var(--ink);stroke-width:1.25;stroke-dasharray:5 3;fill:none}
.ladder{width:auto;height:auto;max-width:none}
.ladder text{font-family:ui-monospace,"SFMono-Regular",Consolas,"DejaVu Sans Mono",monospace;font-size:13px}
.wire{stroke:var(--ink);stroke-width:1.25;fill:none;stroke-linecap:square}
.sign{stroke:var(--ink);stroke-width:1.75;fill:none}
.rail{stroke:var(--ink);stroke-width:3;fill:none}
.added rect{stroke:var(--good);stroke-width:2;fill:none}
.removed rect{stroke:var(--bad);stroke-width:2;fill:none;stroke-dasharray:5 3}
.ladder .added text{fill:var(--good);font-weight:700}
.ladder .removed text{fill:var(--bad);font-weight:700}
.side{flex:1 1 30rem;min-width:0;max-width:100%}
.network{break-inside:avoid}
.cell{fill:none;stroke:var(--quiet);stroke-width:1}
.changed .box{fill:var(--bad);stroke:var(--bad);stroke-width:1}
.changed .cross{fill:none;stroke:var(--paper);stroke-width:2}
.lone path{fill:none;stroke:var(--bad);stroke-width:2}
footer{margin-top:3rem;border-top:1px solid var(--rule);padding-top:.5rem;
 color:var(--quiet);font-size:.875rem}
@media (max-width:40rem){
body{padding:.5rem .9rem 2rem}
h1{font-size:1.4rem}
svg:not(.ladder) text{font-size:14px}
table{font-size:.8125rem}
.scroll table{width:100%;font-size:.75rem}
th,td,tbody th,.scroll tbody th:not(.n),.scroll .text{min-width:0;padding-right:.25rem}
th,td,thead th{overflow-wrap:anywhere}
tbody .n{overflow-wrap:normal}
table code{font-size:inherit}
td time,th time{white-space:normal}
.hex td,.hex tbody th,.hex thead th{padding:.1rem .12rem;font-size:.75rem}
}
@media print{
@page{margin:14mm}
html{font-size:11pt}
body{max-width:none;padding:0}
.skip{display:none}
.scroll{overflow:visible}
.ladder{max-width:100%}
.scroll table{font-size:.75rem}
.scroll .text{min-width:0}
.sides{flex-wrap:nowrap;gap:0 1.5rem}
.hex td,.hex tbody th,.hex thead th{font-size:.75rem;padding:.05rem .2rem}
h2,h3,h2+p,caption,figcaption{break-after:avoid}
figure,tr,.page,.verdict,dl>div{break-inside:avoid}
thead{display:table-header-group;break-after:avoid}
details:not([open]){display:none}
a{color:inherit;text-decoration:none}
}
"""

SHEET: Final = (
    f":root{{color-scheme:light dark;{_colours(LIGHT)}}}\n"
    f"@media screen and (prefers-color-scheme:dark){{:root{{{_colours(DARK)}}}}}"
    f"{_SHEET}"
)
SHEET_HASH: Final = "sha256-" + base64.b64encode(hashlib.sha256(SHEET.encode()).digest()).decode()
