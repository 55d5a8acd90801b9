"""Evidence packs of audits: all tables, a statement about every drive, and the data that reproduce the worst findings."""

from __future__ import annotations

from drivelint.pack.audits.tables import is_audit, is_packed
from drivelint.pack.audits.verify import verified
from drivelint.pack.audits.write import content

__all__ = ["content", "is_audit", "is_packed", "verified"]
