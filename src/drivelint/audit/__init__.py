"""Audits: many workers judge many drives. After an interruption, the next run continues from the results so far.

The key of a drive's result is a hash of everything that determines the result. A worker writes a batch of drives as one Parquet file per
table, and then one receipt per drive. A drive without a receipt has no result. Batches are later packed into chunks of some thousand
drives.
"""

from drivelint.audit.model import JudgeSettings
from drivelint.audit.run import AuditRequest, audit, merge
from drivelint.audit.summary import AuditSummary

__all__ = ["AuditRequest", "AuditSummary", "JudgeSettings", "audit", "merge"]
