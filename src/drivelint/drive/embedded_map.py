"""Finds the OpenDRIVE map that a log carries in its messages."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.drive.trace import OWN_MAP_UNUSABLE, QualityFinding
from drivelint.phrases import listed

if TYPE_CHECKING:
    from collections.abc import Mapping


def single_map(maps: Mapping[bytes, str]) -> tuple[bytes | None, tuple[QualityFinding, ...]]:
    """Return the log's only map, or None with a finding if it has several; `maps`: map text -> topic where it was first seen."""
    if len(maps) > 1:
        message = f"the log has {len(maps)} different OpenDRIVE maps (topics {listed(sorted(maps.values()))}), and none is used: keep one"
        return None, (unusable_finding(message),)
    return next(iter(maps), None), ()


def unusable_finding(message: str) -> QualityFinding:
    """Return the finding that the log's own map cannot be used."""
    return QualityFinding(OWN_MAP_UNUSABLE, "warning", message)
