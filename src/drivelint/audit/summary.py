"""What an audit comes to, and its exit code."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from drivelint.audit.compact import tables_digest
from drivelint.errors import ExitCode
from drivelint.result.counts import SEVERITIES
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

    from drivelint.audit.model import Receipt


@dataclass
class AuditSummary:
    """What an audit comes to. `digest` is that of all rows; None where the results are not packed (`--shard`, `--claim`)."""

    n_drives: int = 0
    judged: int = 0
    reused: int = 0
    lossy: int = 0
    refused: int = 0
    quarantined: int = 0
    km: float = 0.0
    hours: float = 0.0
    failed: dict[str, int] = field(default_factory=dict)
    unknown: int = 0
    errors: int = 0
    digest: str | None = None

    def count(self, receipt: Receipt) -> None:
        """Add a drive."""
        self.n_drives += 1
        self.reused += receipt.reused
        self.judged += receipt.status == "judged"
        self.refused += receipt.status == "refused"
        self.quarantined += receipt.status == "quarantined"
        self.lossy += receipt.lossy
        self.km += receipt.km
        self.hours += receipt.duration_s / 3600
        self.failed = dict(Counter(self.failed) + Counter(receipt.failed))
        self.unknown += receipt.unknown
        self.errors += receipt.counts.get("error", 0)

    def exit_code(self, fail_on: str, *, strict: bool) -> ExitCode:
        """Return the exit code of DESIGN.md, by its precedence 2 > 1 > 4 > 3 > 0."""
        gating = SEVERITIES[: SEVERITIES.index(fail_on) + 1] if fail_on != "never" else ()
        if self.errors:
            return ExitCode.USAGE
        if any(self.failed.get(severity) for severity in gating):
            return ExitCode.FAILED
        nothing = not self.n_drives and self.digest is not None  # of shards and claims, others may have had all
        if self.refused or self.quarantined or nothing or (strict and self.unknown):
            return ExitCode.NOT_JUDGED
        return ExitCode.LOSSY if self.lossy else ExitCode.OK


def summed(con: duckdb.DuckDBPyConnection, n_reused: int) -> AuditSummary:
    """Return what all drives that have receipts come to; `n_reused`: those that had one before."""
    (row,) = con.execute(statement("audit/summed")).to_arrow_table().to_pylist()
    failed = dict(con.execute(statement("audit/failed")).fetchall())
    return AuditSummary(**row, reused=n_reused, failed=failed, digest=tables_digest(con))
