"""The client's parts of each protocol, by the names of ``--protocol``; loaded when needed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.errors import UsageError
from fatektool.protocols import Loaded

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fatektool.protocol.codec import Codec
    from fatektool.protocol.explain import Explainer

CODECS: Final[Mapping[str, Codec]] = Loaded("codec")
_EXPLAINERS: Final[Mapping[str, Callable[[Codec], Explainer]]] = Loaded("explainer")


def codec_named(protocol: str) -> Codec:
    """The codec of this name.

    Raises:
        UsageError: there is none.
    """
    if protocol not in CODECS:
        raise UsageError(f"protocol {protocol!r}: expected one of {', '.join(CODECS)}")
    return CODECS[protocol]


def new_explainer(protocol: str) -> Explainer:
    """A new explainer for one conversation.

    Raises:
        UsageError: there is no such protocol.
    """
    codec = codec_named(protocol)
    return _EXPLAINERS[protocol](codec)
