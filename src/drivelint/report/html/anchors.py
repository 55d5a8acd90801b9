"""Anchors of findings, drives, rules, incidents and overtakes in the HTML report.

Ids of drives and rules come from file names, so they may contain any character.
"""

from __future__ import annotations

import hashlib
import re
from typing import Final

_PLAIN_ID: Final = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,79}")


def anchor(kind: str, *key: str | int) -> str:
    """Return an anchor: `key` is the id of a finding, drive or rule, or the several keys of a moment, overtake or timeline.

    The anchor contains an id of letters, digits, dots, `_` and `-` unchanged; any other id, and several keys, as a hash.
    """
    if len(key) > 1:
        return f"{kind}-{hashlib.sha256(repr(key).encode()).hexdigest()[:12]}"
    name = str(key[0])
    if not _PLAIN_ID.fullmatch(name):
        name = hashlib.sha256(name.encode("utf-8", "surrogatepass")).hexdigest()[:16]
    return f"{kind}-{name}"
