"""The OpenDRIVE map that a log carries: the only one of those found in its messages."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.drive.trace import OWN_MAP_UNUSABLE, Finding
from drivelint.phrases import listed

if TYPE_CHECKING:
    from collections.abc import Mapping


def only(maps: Mapping[bytes, str]) -> tuple[bytes | None, tuple[Finding, ...]]:
    """Return the map, and what is wrong where there are several; `maps`: text -> the topic it was first seen on."""
    if len(maps) > 1:
        message = f"the log has {len(maps)} different OpenDRIVE maps (topics {listed(sorted(maps.values()))}), and none is used: keep one"
        return None, (unusable(message),)
    return next(iter(maps), None), ()


def unusable(message: str) -> Finding:
    """Return the finding that the log's own map cannot be used."""
    return Finding(OWN_MAP_UNUSABLE, "warning", message)
