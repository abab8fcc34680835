from __future__ import annotations

from hypothesis import settings

settings.register_profile("protocol", deadline=None)  # a slow machine is no fault of the protocol
settings.load_profile("protocol")
