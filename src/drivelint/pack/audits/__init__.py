"""Evidence packs of audits: all tables, a statement about every drive, and the data that reproduce the worst findings."""

from __future__ import annotations

from drivelint.pack.audits.tables import is_audit_folder, is_pack_of_audit, packed_findings_text
from drivelint.pack.audits.verify import verify_audit_pack
from drivelint.pack.audits.write import functions_that_pack_audit

__all__ = [
    "functions_that_pack_audit",
    "is_audit_folder",
    "is_pack_of_audit",
    "packed_findings_text",
    "verify_audit_pack",
]
