"""The code page of a project's comments.

The file does not contain it. It is the page in which all comments can be decoded; if several are possible,
the one in which they look most like words: accented letters next to letters, common ideographs next to each
other.
"""

from __future__ import annotations

import codecs
import unicodedata
from typing import TYPE_CHECKING, Final, NamedTuple

from fatektool.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

SINGLE: Final = {
    "cp1252": "àáâãäåæçèéêëìíîïñòóôõöøùúûüýÿœšžßÀÁÂÃÄÅÆÇÈÉÊËÌÍÎÏÑÒÓÔÕÖØÙÚÛÜÝŒ",
    "cp1250": "áâăäąćçčďđéęëěíîĺľłńňóôőöŕřśšşťţúůűüýźżžßÁÂĂÄĄĆÇČĎĐÉĘËĚÍÎĹĽŁŃŇÓÔŐÖŔŘŚŠŞŤŢÚŮŰÜÝŹŻŽ",
    "cp1254": "çğıİöşüâîûÇĞÖŞÜ",
}
"""Code pages with one byte for each character, and the letters of their languages."""
DOUBLE: Final = {"cp932": (0x88, 0x97), "cp936": (0xB0, 0xD7), "cp950": (0xA4, 0xC6)}
"""Code pages with two bytes, and the first bytes of common ideographs."""
CODE_PAGES: Final = ("cp1250", "cp1252", "cp932", "cp936", "cp950", "cp1254")
NAMED: Final = ("cp874", "cp949", "cp1251", "cp1253", "cp1255", "cp1256", "cp1257", "cp1258")
"""Those of Thai, Korean, Cyrillic, Greek, Hebrew, Arabic and Persian, Baltic and Vietnamese: never chosen, as
their letters look like words in other pages too, but taken from the user."""
LAST_RESORT: Final = "latin-1"
_SIGNS: Final = "°²³µ±×÷§·–—…‘’“”€"  # noqa: RUF001  # what is meant
_VOWELS: Final = "aeiouyáéíóú"
_CONSONANTS: Final = "bcdfghjklmnpqrstvwxyz"
_BEFORE: Final = {
    **dict.fromkeys("ùòìÈ", " "),
    **dict.fromkeys("øè", _CONSONANTS),
    "ñ": _VOWELS,
    "õ": "e",
    "œ": "u",
    "û": "t",
}
"""Letters of cp1252 whose code is a Central European letter in cp1250, and what follows them in the languages
of cp1252: the end of a word (a space), a consonant, a vowel."""
_TURKISH: Final = "ğıİşŞĞ"
_ASCII: Final = 0x80
_FULL: Final = (15, 16)
"""An element's comment has at most 16 bytes: one with 16 may have been cut."""
_LOOKED_AT: Final = 1000
_LONGEST: Final = 200
"""The number of texts, and of bytes of each, for the decision; all texts must decode."""


class Choice(NamedTuple):
    """A code page, and whether it is certain.

    Attributes:
        name: as in Python.
        sure: False if no code page decodes all comments.
    """

    name: str
    sure: bool


def code_page(name: str) -> str:
    """Check a code page that the user gave.

    Raises:
        UsageError: it is unknown.
    """
    known = (*CODE_PAGES, *NAMED, LAST_RESORT)
    if name not in known:
        raise UsageError(f"unknown code page {name!r}: expected {', '.join(known[:-1])} or {known[-1]}")
    return name


def choose(texts: Sequence[bytes]) -> Choice:
    """The code page of these texts."""
    found = []
    telling = [text for text in texts if not text.isascii()][:_LOOKED_AT]
    for name in (*SINGLE, *DOUBLE):
        if _all(texts, name) is not None:
            looked_at = _all(telling, name) or []
            found.append((name, sum(_likeness(text[:_LONGEST], name) for text in looked_at)))
    if not found:
        return Choice(LAST_RESORT, sure=False)
    return Choice(max(found, key=lambda each: each[1])[0], sure=True)


def decoded(text: bytes, name: str) -> str:
    """A text in a code page, without half a character at the end of a text with the maximum length.

    Raises:
        UnicodeDecodeError: it does not decode.
    """
    decoder = codecs.getincrementaldecoder(name)("strict")
    return decoder.decode(text, final=len(text) not in _FULL)


def _all(texts: Iterable[bytes], name: str) -> list[str] | None:
    try:
        return [decoded(text, name) for text in texts]
    except UnicodeDecodeError:
        return None


def _likeness(text: str, name: str) -> int:
    """A score: how much a text looks like words in a language of this code page."""
    score = 0
    for place, letter in enumerate(text):
        if ord(letter) >= _ASCII:
            after = text[place + 1 : place + 2]
            around = text[max(0, place - 1) : place] + after
            if name in SINGLE:
                score += _letter(letter, around, after or " ", name)
            else:
                score += _ideograph(letter, around, name)
    return score


def _letter(letter: str, around: str, after: str, name: str) -> int:
    if letter in _SIGNS:
        return 0
    if letter not in SINGLE[name]:
        return -1
    is_odd = name == "cp1252" and after.lower() not in _BEFORE.get(letter, after.lower())
    if is_odd or not any(near.isascii() and near.isalpha() for near in around):
        return 1
    return 3 if letter in _TURKISH else 2


def _ideograph(letter: str, around: str, name: str) -> int:
    if any(near.isascii() and near.islower() for near in around):
        return -2
    raw = letter.encode(name)
    if len(raw) == 1:  # katakana of half width
        return 1 if any(unicodedata.name(near, "").startswith("HALFWIDTH") for near in around) else -1
    if unicodedata.name(letter, "").startswith(("HIRAGANA", "KATAKANA")):
        return 4 if name == "cp932" else 0
    first, last = DOUBLE[name]
    common = first <= raw[0] <= last and (name != "cp936" or raw[1] > 0xA0)
    if common:
        return 3
    return -1 if unicodedata.name(letter, "").startswith("CJK UNIFIED") else 0
