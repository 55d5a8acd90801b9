"""What the fleet page says of an audit, in whatever format: gathered from SQL, each table as long as it is shown."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from drivelint.fleet.coverage import Coverage, coverage
from drivelint.fleet.missing import Missing, missing
from drivelint.fleet.rates import Rate, rates
from drivelint.fleet_report.by_tag import RatesByTag, rates_by_tag
from drivelint.fleet_report.difference import AuditDifference, difference, verdict_counts
from drivelint.fleet_report.drive_command import check_command
from drivelint.fleet_report.figures import LogAxis, log_axis
from drivelint.fleet_report.places import FindingMap, finding_map
from drivelint.result.certainty import LEAST_SHARE
from drivelint.result.counts import SEVERITIES
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Sequence

    import duckdb

    from drivelint.fleet_report.opened import Audit

    Row = dict[str, Any]

MAX_DRIVES: Final = 50
"""Drives in a table."""
MAX_CHANGES: Final = 50
"""Findings of each standing against a baseline."""


@dataclass(frozen=True)
class FleetContent:
    """An audit as the fleet page tells it.

    `totals`: the row of `drives.sql`. `severities`: severity -> row of `severities.sql`. `rules`: rule_id -> row of the table `rule`.
    `rates`: the gravest and most frequent first. `worst`: rows of `worst.sql` with `command`. `not_judged`: some of the drives.
    """

    audit: Audit
    totals: Row
    severities: dict[str, Row]
    verdicts: dict[str, int]
    rules: dict[str, Row]
    rates: list[Rate]
    axis: LogAxis
    worst: list[Row]
    n_drives_with_findings: int
    not_judged: list[Row]
    by_tag: list[RatesByTag]
    coverage: Coverage
    missing: Missing
    places: FindingMap | None
    baseline: AuditDifference | None

    @property
    def n_findings(self) -> int:
        """Number of all findings."""
        return sum(row["findings"] for row in self.severities.values())

    @property
    def n_not_judged(self) -> int:
        """Number of drives that could not be judged."""
        return int(self.totals["drives"] - self.totals["judged"])

    @property
    def is_all_decided(self) -> bool:
        """Whether the audit has ended, drives were judged, and none of their verdicts is open."""
        left = self.verdicts["unknown"] or self.verdicts["error"] or self.n_not_judged or self.audit.warning
        return bool(self.totals["judged"]) and not left

    @property
    def headline(self) -> tuple[str, str]:
        """The outcome (fail, unknown or pass), and the sentence at the top."""
        if self.n_findings:
            said = ", ".join(
                f"{self.severities[name]['findings']:,} {name}" for name in SEVERITIES if name in self.severities
            )
            noun = "finding" if self.n_findings == 1 else "findings"
            return "fail", f"{said} {noun} in {self.n_drives_with_findings:,} of {self.totals['drives']:,} drives"
        if not self.verdicts["pass"]:
            return "unknown", "Nothing could be decided"
        if self.audit.warning or self.verdicts["unknown"] or self.verdicts["error"] or self.n_not_judged:
            return "unknown", "No finding, as far as it could be judged"
        return "pass", "No finding"


def content(con: duckdb.DuckDBPyConnection, audit: Audit, base: Audit | None, by: Sequence[str]) -> FleetContent:
    """Return what there is to say of an audit of `opened`. Errors: `UsageError` for a tag in `by` that no drive has."""
    share = str(LEAST_SHARE)
    (totals,) = _rows(con, "drives", of="")
    columns = {row[0] for row in con.execute("DESCRIBE receipts").fetchall()}
    worst = _rows(
        con,
        "worst",
        {"most": MAX_DRIVES},
        least_share=share,
        options="r.options" if "options" in columns else "NULL",  # receipts of older audits do not have them
    )
    for row in worst:
        row["command"] = check_command(row["log"], row["options"], audit.settings, row["drive_id"])
        row["tags"] = dict(row["tags"] or ())
    rules = {row["rule_id"]: row for row in con.execute("FROM rules ORDER BY ALL").to_arrow_table().to_pylist()}
    found = sorted(rates(con), key=lambda rate: _gravest_first(rate, rules))
    with_findings = con.execute("SELECT count(DISTINCT key) FROM findings").fetchall()[0][0]
    return FleetContent(
        audit=audit,
        totals=totals,
        severities={row["severity"]: row for row in _rows(con, "severities", least_share=share)},
        verdicts=verdict_counts(con, ""),
        rules=rules,
        rates=found,
        axis=log_axis(rate.per_100km for rate in found if rate.findings),
        worst=worst,
        n_drives_with_findings=with_findings,
        not_judged=_rows(con, "not_judged", {"most": MAX_DRIVES}),
        by_tag=[rates_by_tag(con, tag) for tag in dict.fromkeys(by)],
        coverage=coverage(con),
        missing=missing(con),
        places=finding_map(con),
        baseline=None if base is None else difference(con, audit, base, MAX_CHANGES),
    )


def _gravest_first(rate: Rate, rules: dict[str, Row]) -> tuple[Any, ...]:
    severity = SEVERITIES.index(rules[rate.rule_id]["severity"])
    n = rate.findings + rate.findings_of_unknown
    return (not n, severity, -(rate.per_100km.rate or 0.0), -n, rate.rule_id, rate.profile or "")


def _rows(con: duckdb.DuckDBPyConnection, name: str, bound: Row | None = None, **fragments: str) -> list[Row]:
    rows: list[Row] = (
        con.execute(statement(f"fleet_report/{name}", **fragments), bound or {}).to_arrow_table().to_pylist()
    )
    return rows
