"""Anchors of findings, drives, rules, incidents and overtakes in the HTML report. Ids of drives and rules come from file names:
anything may be in them."""

from __future__ import annotations

import hashlib
import re
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Mapping

_PLAIN: Final = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,79}")


def finding_anchor(finding: Mapping[str, Any]) -> str:
    """Return the anchor of a finding: `finding-<its id>`."""
    return f"finding-{_safe(finding['finding_id'])}"


def drive_anchor(drive_id: str) -> str:
    """Return the anchor of a drive."""
    return f"drive-{_safe(drive_id)}"


def rule_anchor(rule_id: str) -> str:
    """Return the anchor of a rule."""
    return f"rule-{_safe(rule_id)}"


def incident_anchor(drive_id: str, ego_id: str, t_ns: int) -> str:
    """Return the anchor of a moment of an ego."""
    return f"moment-{_hash(drive_id, ego_id, t_ns)}"


def overtake_anchor(drive_id: str, ego_id: str, occurrence: int) -> str:
    """Return the anchor of an overtake."""
    return f"overtake-{_hash(drive_id, ego_id, occurrence)}"


def timeline_axis_id(drive_id: str, ego_id: str) -> str:
    """Return the name of the grid that the rows of a timeline share."""
    return f"grid-{_hash(drive_id, ego_id)}"


def _hash(*key: str | int) -> str:
    return hashlib.sha256(repr(key).encode()).hexdigest()[:12]


def _safe(name: str) -> str:
    """Return a name as it is if it is plain, else a hash of it."""
    if _PLAIN.fullmatch(name):
        return name
    return hashlib.sha256(name.encode("utf-8", "surrogatepass")).hexdigest()[:16]
