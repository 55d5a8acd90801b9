"""Audits: many drives judged by many workers, with results that stay when the audit is interrupted and resumed.

The key of a drive's result is a hash of everything that decides it. Workers write a batch of drives as one Parquet file per table and
then a receipt per drive; a drive without a receipt has no result. Small files are packed into chunks of some thousand drives.
"""

from drivelint.audit.model import JudgeSettings
from drivelint.audit.run import AuditRequest, audit, merge
from drivelint.audit.summary import AuditSummary

__all__ = ["AuditRequest", "AuditSummary", "JudgeSettings", "audit", "merge"]
