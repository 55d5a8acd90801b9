"""Reads the geo reference of a map and compares it with that of a log."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from drivelint.road.map_reader import MapSource

_REFERENCE: Final = re.compile(rb"<geoReference[^>]*>(.*?)</geoReference>", re.DOTALL)
_CDATA: Final = re.compile(r"<!\[CDATA\[(.*?)\]\]>", re.DOTALL)
_HEAD_BYTES: Final = 65536
_SILENT: Final = frozenset({"no_defs", "wktext", "type", "units", "vunits", "geoidgrids"})
"""What does not move a place in the plane (lengths are metres in all our formats)."""
_DEFAULTS: Final = {("x_0", "0.0"), ("y_0", "0.0"), ("k", "1.0"), ("k_0", "1.0")}
"""What holds without being said."""
_DIGITS: Final = 9
"""Decimals that are compared: a tenth of a millimetre on the ground, even of a degree; writers round the last of theirs."""


def reference_of(source: MapSource) -> str | None:
    """Return the geo reference in an OpenDRIVE header, None where there is none or it is empty."""
    found = _REFERENCE.search(source.content[:_HEAD_BYTES])
    if found is None:
        return None
    text = found[1].decode("utf-8", "replace")
    inner = _CDATA.search(text)
    return (inner[1] if inner else text).strip() or None


def same_reference(one: str, other: str) -> bool:
    """Say whether two references mean the same: PROJ strings parameter by parameter, other texts word by word."""
    return _parsed(one) == _parsed(other)


def different_places(one: str, other: str) -> bool:
    """Return whether two unequal references mean different places: both must be PROJ strings with a projection."""
    return all("proj" in dict(_parsed(text)) for text in (one, other))


def _parsed(text: str) -> frozenset[tuple[str, str]]:
    words = text.split()
    if not any(word.startswith("+") for word in words):
        return frozenset({("", " ".join(words))})
    pairs = (word.removeprefix("+").partition("=")[::2] for word in words)
    said = {(key, _plain(value)) for key, value in pairs if key not in _SILENT}
    return frozenset(said - _DEFAULTS)


def _plain(value: str) -> str:
    try:
        return repr(round(float(value), _DIGITS) + 0.0)
    except ValueError:
        return value
