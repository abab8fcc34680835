"""The speeds and formats of these PLCs, the most likely first.

FBs manuals, chapter 12: 4800 to 921600 baud. 9600 7E1 is the factory setting of ports 0, 1, 3 and 4; that of
the high-speed port 2 is 153600 8E1. Known from plants: 9600, 38400 and 115200 7E1, and 9600 8E1.
"""

from __future__ import annotations

from typing import Final

BAUDS: Final = (
    *(9600, 38400, 19200, 115200, 57600, 4800, 153600),
    *(230400, 921600, 307200, 614400, 76800, 28800, 14400, 7200),
)
"""The most likely first."""

FORMATS: Final = ("7E1", "8E1", "8N1")
"""The most likely first."""
