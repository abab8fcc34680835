"""The speeds and formats that these PLCs have, in the order in which it pays to try them.

FBs manuals, chapter 12: 4800 to 921600 baud. 9600 7E1 is the factory setting of ports 0, 1, 3 and 4; that of
the high-speed port 2 is 153600 8E1. In plants 9600, 38400 and 115200 7E1 and 9600 8E1 were met.
"""

from __future__ import annotations

from typing import Final

BAUDS: Final = (
    *(9600, 38400, 19200, 115200, 57600, 4800, 153600),
    *(230400, 921600, 307200, 614400, 76800, 28800, 14400, 7200),
)
"""The likeliest first."""

FORMATS: Final = ("7E1", "8E1", "8N1")
"""The likeliest first."""
