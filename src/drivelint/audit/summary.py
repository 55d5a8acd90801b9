"""The summary of an audit, and its exit code."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import pyarrow.compute as pc

from drivelint.audit.compact import tables_digest
from drivelint.errors import ExitCode
from drivelint.fleet.distinct_logs import COUNTED_PREFIX, create_counted_views
from drivelint.phrases import listed, plural
from drivelint.reasons.signals import UNRECORDED_PREFIX
from drivelint.result.certainty import LEAST_SHARE
from drivelint.result.counts import SEVERITIES
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

    from drivelint.audit.model import Receipt


MOST_RULES: Final = 5
MOST_REASONS: Final = 3
MOST_COPIES: Final = 3
MOST_LOGS: Final = 3
_NAMES_IN_FILE: Final = {"n_judged": "judged", "n_refused": "refused"}
"""Fields with another name in `summary.json`."""
_UNDECIDED: Final = "nothing failed, because nothing could be decided"


@dataclass
class AuditSummary:
    """The summary of an audit. `digest` is that of all rows; None where the results are not packed (`--shard`, `--claim`).

    `off_map`: drives that their map does not fit. `failed`: severity -> failed verdicts of stable rules; `findings`: severity -> findings.
    `errors`: verdicts that are errors; `beyond_limits`: of these, those of rules that took too much time or memory.
    `n_asked`: drives of the sources, `n_absent`: results of others, from earlier runs. `missing_parts`: shards that have not come to
    their end. `copies`: judged drives whose logs have the content of another judged one's; `copies_not_judged`: those of the drives that
    were not judged. Of a whole audit, way, time, findings, contacts and unknown verdicts are those of each content once, as on the fleet
    page. `contacts`: drives with a contact that is sure or was not examined; `contacts_possible`: the others with one. In `findings`, a
    touch of two egos counts once; `possible`: those that are only possible.
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
    """The first of each: rules that were broken, reasons for unknown verdicts, drives that were not judged, copies (`log`, `other`,
    `same_options`)."""
    lossy_logs: list[str] = field(default_factory=list)
    off_map_logs: list[str] = field(default_factory=list)
    """The first lossy logs, and of those that are off their map; logs of one content are one."""
    undecided: str | None = None
    """Why nothing at all could be decided; None: something was."""
    n_broken: int = 0
    n_unknown_for: int = 0
    """How many rules were broken, and how many reasons for unknown verdicts there are."""

    def count(self, receipt: Receipt) -> None:
        """Add a drive."""
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

    def plain(self) -> dict[str, Any]:
        """Return name in `summary.json` -> value."""
        return {_NAMES_IN_FILE.get(name, name): value for name, value in vars(self).items()}

    def plus(self, second: AuditSummary) -> AuditSummary:
        """Return the sums of both, without the counts that only a whole audit has."""
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
        both = {name: getattr(self, name) + getattr(second, name) for name in names}
        return replace(self, **both, failed=dict(Counter(self.failed) + Counter(second.failed)))

    def exit_code(self, fail_on: str, *, strict: bool) -> ExitCode:
        """Return the exit code of DESIGN.md, by its precedence 2 > 1 > 4 > 3 > 0."""
        gating = SEVERITIES[: SEVERITIES.index(fail_on) + 1] if fail_on != "never" else ()
        if self.errors > self.beyond_limits:
            return ExitCode.USAGE
        if any(self.failed.get(severity) for severity in gating):
            return ExitCode.FAILED
        nothing = not self.n_drives and self.digest is not None  # of shards and claims, others may have had all
        if (
            self.n_refused
            or self.quarantined
            or self.beyond_limits
            or self.off_map
            or self.missing_parts
            or self.undecided
            or nothing
            or (strict and self.unknown)
        ):
            return ExitCode.NOT_JUDGED
        return ExitCode.LOSSY if self.lossy else ExitCode.OK

    def exit_reason(self, code: ExitCode, fail_on: str) -> str:
        """Return in one sentence why an audit exits with this code."""
        if code is ExitCode.USAGE:
            return f"{plural(self.errors - self.beyond_limits, 'verdict')} in error: could not be run"
        if code is ExitCode.FAILED:
            severe = SEVERITIES[: SEVERITIES.index(fail_on) + 1]
            n = sum(self.findings.get(severity, 0) for severity in severe)
            bare = sum(self.failed.get(severity, 0) for severity in severe)
            what = plural(n, "finding") if n else f"{plural(bare, 'failed verdict')} without a finding"
            return f"{what} at or above severity {fail_on}"
        if code is ExitCode.LOSSY:
            return "judged on lossy input: parts of a log were lost"
        if code is ExitCode.NOT_JUDGED:
            return self._not_judged_reason()
        return "failures do not gate" if fail_on == "never" else f"nothing failed at or above severity {fail_on}"

    def _not_judged_reason(self) -> str:
        if lost := self.n_refused + self.quarantined:
            return f"{lost} of {plural(self.n_drives, 'drive')} could not be judged"
        if self.beyond_limits:
            return f"{plural(self.beyond_limits, 'verdict')} in error: exceeded its limits"
        if self.off_map:
            return f"the map does not fit {self.off_map} of {plural(self.n_drives, 'drive')}"
        if self.missing_parts:
            return f"parts have not ended: {listed(self.missing_parts)}"
        return self.undecided or (
            f"{plural(self.unknown, 'verdict')} unknown (--strict)" if self.unknown else "no drive was judged"
        )


def summed_receipts(con: duckdb.DuckDBPyConnection, of: str) -> AuditSummary:
    """Return the sums of these receipts; `of`: a relation with the columns of `receipts`."""
    (row,) = con.execute(statement("audit/summed", of=of)).to_arrow_table().to_pylist()
    return AuditSummary(**row, failed=dict(con.execute(statement("audit/failed", of=of)).fetchall()))


class LogList(NamedTuple):
    """The number of some logs, and the first of them."""

    n: int
    logs: list[str]


def logs_that_are(con: duckdb.DuckDBPyConnection, flag: str) -> LogList:
    """Return the logs that are `lossy` or `off_map`, of one content one; those of an older audit may not say the latter."""
    if flag not in con.table("receipts").columns:
        return LogList(0, [])
    rows = con.execute(statement("audit/logs_that_are", what=flag)).fetchall()
    return LogList(len(rows), [log for (log,) in rows[:MOST_LOGS]])


def summed(con: duckdb.DuckDBPyConnection, n_reused: int) -> AuditSummary:
    """Return the sums of all drives with receipts; `n_reused`: those that had one before."""
    create_counted_views(con)
    event = statement("fleet/event", of=COUNTED_PREFIX, least_share=str(LEAST_SHARE))
    broken, contacts, unknown_for, not_judged = (
        con.execute(statement(f"audit/{name}", event=event)).to_arrow_table()
        for name in ("broken", "contacts", "unknown", "not_judged")
    )
    (is_undecided,) = con.execute(statement("audit/undecided"), {"unrecorded": UNRECORDED_PREFIX}).fetchall()[0]
    (totals,) = con.execute(statement("fleet/totals")).to_arrow_table().to_pylist()
    findings = broken.group_by("severity").aggregate([("n_findings", "sum")]).to_pylist()
    return replace(
        summed_receipts(con, "receipts"),
        reused=n_reused,
        **contacts.to_pylist()[0],
        copies=totals["copies"] - totals["copies_not_judged"],
        copies_not_judged=totals["copies_not_judged"],
        km=totals["km"],
        hours=totals["log_hours"],
        possible=pc.sum(broken["n_possible"]).as_py() or 0,
        unknown=pc.sum(unknown_for["n"]).as_py() or 0,
        digest=tables_digest(con),
        findings={
            each["severity"]: each["n_findings_sum"] for each in sorted(findings, key=lambda each: each["severity"])
        },
        broken=broken.slice(0, MOST_RULES).to_pylist(),
        unknown_for=unknown_for.slice(0, MOST_REASONS).to_pylist(),
        not_judged=not_judged.slice(0, MOST_REASONS).to_pylist(),
        undecided=_UNDECIDED if is_undecided else None,
        n_broken=broken.num_rows,
        n_unknown_for=unknown_for.num_rows,
        lossy_logs=logs_that_are(con, "lossy").logs,
        off_map_logs=logs_that_are(con, "off_map").logs,
        copied=con.execute(statement("audit/copied"), {"most": MOST_COPIES}).to_arrow_table().to_pylist(),
    )
