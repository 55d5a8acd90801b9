"""The summary of an audit, and its exit code."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import pyarrow.compute as pc

from drivelint.audit.compact import tables_digest
from drivelint.errors import ExitCode
from drivelint.fleet.distinct_logs import COUNTED_PREFIX, create_counted_views
from drivelint.phrases import name_list, plural
from drivelint.reasons.signals import UNRECORDED_PREFIX
from drivelint.result.certainty import LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING
from drivelint.result.counts import SEVERITIES
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

    from drivelint.audit.model import Receipt


MOST_LISTED_RULES: Final = 5
MOST_LISTED_REASONS: Final = 3
MOST_LISTED_REPEATED_LOGS: Final = 3
MOST_LISTED_LOGS: Final = 3
_KEY_IN_SUMMARY_FILE: Final = {"n_judged": "judged", "n_refused": "refused"}
"""Fields that have another name in `summary.json`."""
_UNDECIDED_REASON: Final = "nothing failed, because nothing could be decided"


@dataclass
class AuditSummary:
    """The summary of an audit. `digest`: hash of all rows; None if the results are not packed (`--shard`, `--claim`).

    `off_map`: drives that their map does not fit. `failed`: severity -> failed verdicts of stable rules. `findings`: severity -> findings.
    `errors`: verdicts `error`; `beyond_limits`: how many of these exceeded the limits of time or memory.
    `n_asked`: drives of the sources. `n_absent`: results of other drives, from earlier runs. `missing_parts`: parts that have not ended.
    `copies`: judged drives whose log has the same content as the log of another judged drive. `copies_not_judged`: the same for drives that
    were not judged. In the summary of a whole audit, kilometres, hours, findings, contacts and unknown verdicts count each content once.
    `contacts`: drives with a contact that is certain or was not examined. `contacts_possible`: drives whose contacts are all only possible.
    `findings` counts a contact of two egos once. `possible`: findings that are only possible.
    """

    n_drives: int = 0
    n_judged: int = 0
    reused: int = 0
    lossy: int = 0
    off_map: int = 0
    n_refused: int = 0
    quarantined: int = 0
    km: float = 0.0
    hours: float = 0.0
    failed: dict[str, int] = field(default_factory=dict)
    unknown: int = 0
    errors: int = 0
    beyond_limits: int = 0
    digest: str | None = None
    robust: bool = False
    n_asked: int | None = None
    n_absent: int = 0
    missing_parts: list[str] = field(default_factory=list)
    copies: int = 0
    copies_not_judged: int = 0
    findings: dict[str, int] = field(default_factory=dict)
    possible: int = 0
    contacts: int = 0
    contacts_possible: int = 0
    broken: list[dict[str, Any]] = field(default_factory=list)
    unknown_for: list[dict[str, Any]] = field(default_factory=list)
    not_judged: list[dict[str, Any]] = field(default_factory=list)
    copied: list[dict[str, Any]] = field(default_factory=list)
    """The first rows of each kind: broken rules, reasons for unknown verdicts, drives that were not judged, and copies."""
    lossy_logs: list[str] = field(default_factory=list)
    off_map_logs: list[str] = field(default_factory=list)
    """The first lossy logs, and the first logs that their map does not fit. Logs with the same content are listed once."""
    undecided: str | None = None
    """Why no verdict could be decided; None: at least one was decided."""
    n_broken: int = 0
    n_unknown_for: int = 0
    """The number of broken rules, and the number of reasons for unknown verdicts."""

    @property
    def n_distinct_drives(self) -> int:
        """The number of drives; logs with the same content count once."""
        return self.n_drives - self.copies - self.copies_not_judged

    def add_receipt(self, receipt: Receipt) -> None:
        """Add the drive of a receipt to the sums."""
        self.n_drives += 1
        self.reused += receipt.reused
        self.n_judged += receipt.status == "judged"
        self.n_refused += receipt.status == "refused"
        self.quarantined += receipt.status == "quarantined"
        self.lossy += receipt.lossy
        self.off_map += receipt.off_map
        self.km += receipt.km
        self.hours += receipt.duration_s / 3600
        self.failed = dict(Counter(self.failed) + Counter(receipt.failed))
        self.unknown += receipt.unknown
        self.errors += receipt.counts.get("error", 0)
        self.beyond_limits += receipt.beyond_limits

    def file_content(self) -> dict[str, Any]:
        """Return the content of `summary.json`: name -> value."""
        return {_KEY_IN_SUMMARY_FILE.get(name, name): value for name, value in vars(self).items()}

    def plus(self, second: AuditSummary) -> AuditSummary:
        """Return the sums of both summaries, without the counts that only a whole audit has."""
        names = (
            "n_drives",
            "n_judged",
            "lossy",
            "off_map",
            "n_refused",
            "quarantined",
            "copies",
            "km",
            "hours",
            "unknown",
            "errors",
            "beyond_limits",
        )
        sums = {name: getattr(self, name) + getattr(second, name) for name in names}
        return replace(self, **sums, failed=dict(Counter(self.failed) + Counter(second.failed)))

    def exit_code(self, fail_on: str, *, strict: bool) -> ExitCode:
        """Return the exit code: the first that applies of 2 (USAGE), 1 (FAILED), 4 (NOT_JUDGED), 3 (LOSSY), 0 (OK)."""
        gating = SEVERITIES[: SEVERITIES.index(fail_on) + 1] if fail_on != "never" else ()
        if self.errors > self.beyond_limits:
            return ExitCode.USAGE
        if any(self.failed.get(severity) for severity in gating):
            return ExitCode.FAILED
        is_empty = not self.n_drives and self.digest is not None  # another part may have judged all drives
        if (
            self.n_refused
            or self.quarantined
            or self.beyond_limits
            or self.off_map
            or self.missing_parts
            or self.undecided
            or is_empty
            or (strict and self.unknown)
        ):
            return ExitCode.NOT_JUDGED
        return ExitCode.LOSSY if self.lossy else ExitCode.OK

    def exit_reason(self, code: ExitCode, fail_on: str) -> str:
        """Return one sentence that says why an audit exits with this code."""
        if code is ExitCode.USAGE:
            return f"{plural(self.errors - self.beyond_limits, 'verdict')} in error: could not be run"
        if code is ExitCode.FAILED:
            severe = SEVERITIES[: SEVERITIES.index(fail_on) + 1]
            n = sum(self.findings.get(severity, 0) for severity in severe)
            bare = sum(self.failed.get(severity, 0) for severity in severe)
            subject = plural(n, "finding") if n else f"{plural(bare, 'failed verdict')} without a finding"
            return f"{subject} at or above severity {fail_on}"
        if code is ExitCode.LOSSY:
            return "judged on lossy input: parts of a log were lost"
        if code is ExitCode.NOT_JUDGED:
            return self._reason_of_exit_not_judged()
        return "failures do not gate" if fail_on == "never" else f"nothing failed at or above severity {fail_on}"

    def _reason_of_exit_not_judged(self) -> str:
        if n_lost := self.n_refused + self.quarantined - self.copies_not_judged:
            return f"{n_lost} of {plural(self.n_distinct_drives, 'drive')} could not be judged"
        if self.beyond_limits:
            return f"{plural(self.beyond_limits, 'verdict')} in error: exceeded its limits"
        if self.off_map:
            return f"the map does not fit {self.off_map} of {plural(self.n_distinct_drives, 'drive')}"
        if self.missing_parts:
            return f"parts have not ended: {name_list(self.missing_parts)}"
        return self.undecided or (
            f"{plural(self.unknown, 'verdict')} unknown (--strict)" if self.unknown else "no drive was judged"
        )


def sums_of_receipts(con: duckdb.DuckDBPyConnection, receipts_relation: str) -> AuditSummary:
    """Return the sums over receipts. `receipts_relation`: a relation with the columns of `receipts`."""
    (row,) = con.execute(statement("audit/summed", of=receipts_relation)).to_arrow_table().to_pylist()
    return AuditSummary(**row, failed=dict(con.execute(statement("audit/failed", of=receipts_relation)).fetchall()))


class LogList(NamedTuple):
    """A number of logs, and the names of the first of them."""

    n: int
    logs: list[str]


def logs_with_flag(con: duckdb.DuckDBPyConnection, flag: str) -> LogList:
    """Return the logs with the flag `lossy` or `off_map`; logs with the same content count once. Receipts of older audits may lack
    `off_map`."""
    if flag not in con.table("receipts").columns:
        return LogList(0, [])
    rows = con.execute(statement("audit/logs_that_are", what=flag)).fetchall()
    return LogList(len(rows), [log for (log,) in rows[:MOST_LISTED_LOGS]])


def summary_of_all_drives(con: duckdb.DuckDBPyConnection, n_reused: int) -> AuditSummary:
    """Return the summary of all drives with receipts. `n_reused`: drives that had a result before this run."""
    create_counted_views(con)
    event = statement("fleet/event", of=COUNTED_PREFIX, least_share=str(LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING))
    broken, contacts, unknown_for, not_judged = (
        con.execute(statement(f"audit/{name}", event=event)).to_arrow_table()
        for name in ("broken", "contacts", "unknown", "not_judged")
    )
    (is_undecided,) = con.execute(statement("audit/undecided"), {"unrecorded": UNRECORDED_PREFIX}).fetchall()[0]
    (totals,) = con.execute(statement("fleet/totals")).to_arrow_table().to_pylist()
    findings = broken.group_by("severity").aggregate([("n_findings", "sum")]).to_pylist()
    return replace(
        sums_of_receipts(con, "receipts"),
        reused=n_reused,
        **contacts.to_pylist()[0],
        copies=totals["copies"] - totals["copies_not_judged"],
        copies_not_judged=totals["copies_not_judged"],
        km=totals["km"],
        hours=totals["log_hours"],
        possible=pc.sum(broken["n_possible"]).as_py() or 0,
        unknown=pc.sum(unknown_for["n"]).as_py() or 0,
        digest=tables_digest(con),
        findings={row["severity"]: row["n_findings_sum"] for row in sorted(findings, key=lambda row: row["severity"])},
        broken=broken.slice(0, MOST_LISTED_RULES).to_pylist(),
        unknown_for=unknown_for.slice(0, MOST_LISTED_REASONS).to_pylist(),
        not_judged=not_judged.slice(0, MOST_LISTED_REASONS).to_pylist(),
        undecided=_UNDECIDED_REASON if is_undecided else None,
        n_broken=broken.num_rows,
        n_unknown_for=unknown_for.num_rows,
        lossy_logs=logs_with_flag(con, "lossy").logs,
        off_map_logs=logs_with_flag(con, "off_map").logs,
        copied=con.execute(statement("audit/copied"), {"most": MOST_LISTED_REPEATED_LOGS}).to_arrow_table().to_pylist(),
    )
