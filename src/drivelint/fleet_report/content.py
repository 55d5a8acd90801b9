"""Collects the content of an audit's fleet page for every format. Each table has only the rows that are shown."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from drivelint.audit.summary import LogList, logs_with_flag
from drivelint.catalogue.header import CONTACT_TAG
from drivelint.fleet.coverage import Coverage, coverage
from drivelint.fleet.distinct_logs import COUNTED_PREFIX, counted_egos_sql, create_counted_views
from drivelint.fleet.missing_signals import SignalGaps, missing_signals
from drivelint.fleet.rates import Rate, rates
from drivelint.fleet_report.by_tag import RatesByTag, rates_by_tag
from drivelint.fleet_report.difference import AuditDifference, difference, verdict_counts
from drivelint.fleet_report.drive_command import check_command
from drivelint.fleet_report.figures import LogarithmicAxis, logarithmic_axis
from drivelint.fleet_report.places import FindingMap, finding_map
from drivelint.fleet_report.rows import options_column_sql, query_rows, ranked_drives_sql, severity_order_sql
from drivelint.fleet_report.worst_value import WorstTagValue, worst_tag_value
from drivelint.phrases import plural
from drivelint.result.certainty import LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING
from drivelint.result.counts import SEVERITIES
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Sequence

    import duckdb

    from drivelint.fleet_report.audit_views import Audit
    from drivelint.fleet_report.rows import Row

MAX_DRIVES_PER_TABLE: Final = 50
"""Largest number of drives in a table."""
MAX_FINDINGS_PER_STANDING: Final = 50
"""Largest number of findings per standing (new, fixed, …) in the comparison with a baseline."""


@dataclass(frozen=True)
class FleetContent:
    """The content of the fleet page about an audit.

    `totals`: the row of `totals.sql`. `severities`: severity -> row of `severities.sql`. `rules`: rule_id -> row of the table `rule`.
    `rates`: the most severe and most frequent first. `worst`: rows of `worst.sql` with `command` and `explain`. `not_judged`: some of the
    drives that were not judged. `lossy`: logs of which parts were lost. `off_map`: logs that their map does not fit.
    `contacts`: number of drives in which an ego touched something, and number of drives in which an ego possibly did. `worst_value`: the
    value of a tag whose rate differs most from the others.
    Logs with the same content are one drive. `n_without_rate`: findings that are missing from the rates, because another result of the same
    log is used there.
    """

    audit: Audit
    totals: Row
    severities: dict[str, Row]
    verdicts: dict[str, int]
    rules: dict[str, Row]
    rates: list[Rate]
    axis: LogarithmicAxis
    worst: list[Row]
    n_drives_with_findings: int
    n_without_rate: int
    contacts: tuple[int, int]
    not_judged: list[Row]
    lossy: LogList
    off_map: LogList
    worst_value: WorstTagValue | None
    by_tag: list[RatesByTag]
    coverage: Coverage
    undecided: SignalGaps
    places: FindingMap | None
    baseline: AuditDifference | None

    @property
    def drive_keys(self) -> list[str | None]:
        """The keys of the drives that the page names; None for drives that only the baseline has."""
        since = [] if self.baseline is None else [e.new_key for of in self.baseline.entries.values() for e in of]
        return [*(row["key"] for row in self.worst), *(row["key"] for row in self.not_judged), *since]

    @property
    def n_findings(self) -> int:
        """The number of all findings."""
        return sum(row["findings"] for row in self.severities.values())

    @property
    def n_not_judged(self) -> int:
        """The number of drives that could not be judged."""
        return int(self.totals["drives"] - self.totals["judged"])

    @property
    def certainty_sentence(self) -> str:
        """A sentence about contacts and the certainty of findings; '' if there is no finding."""
        if not self.n_findings:
            return ""
        numbers = zip(("CONTACT", "possible contact"), self.contacts, strict=True)
        touched = [f"{words} in {plural(n, 'drive')}" for words, n in numbers if n]
        n = sum(row["possible"] for row in self.severities.values())
        looked = (
            f"examined: {n:,} only possible"
            if self.audit.settings.get("robustness")
            else "not examined: use audit --robustness"
        )
        sentence = "; ".join([*touched, f"certainty of the findings: {looked}"])
        return sentence[0].upper() + sentence[1:]

    @property
    def is_all_decided(self) -> bool:
        """Whether the audit has ended, all drives were judged, and no verdict is unknown or in error."""
        left = self.verdicts["unknown"] or self.verdicts["error"] or self.n_not_judged or self.audit.warning
        return bool(self.totals["judged"]) and not left

    @property
    def headline(self) -> tuple[str, str]:
        """The outcome (fail, unknown or pass), and the sentence at the top of the page."""
        if self.n_findings:
            counts_text = ", ".join(
                f"{self.severities[name]['findings']:,} {name}" for name in SEVERITIES if name in self.severities
            )
            noun = "finding" if self.n_findings == 1 else "findings"
            of = (
                f"{self.totals['judged']:,} judged drives" if self.n_not_judged else f"{self.totals['drives']:,} drives"
            )
            return "fail", f"{counts_text} {noun} in {self.n_drives_with_findings:,} of {of}"
        if not self.verdicts["pass"]:
            return "unknown", "Nothing could be decided"
        if self.audit.warning or self.verdicts["unknown"] or self.verdicts["error"] or self.n_not_judged:
            return "unknown", "No finding, but not everything could be judged"
        return "pass", "No finding"


def fleet_content(
    con: duckdb.DuckDBPyConnection, audit: Audit, base: Audit | None, tags: Sequence[str]
) -> FleetContent:
    """Return the content of the page about an audit from `open_audits`. Errors: `UsageError` for a tag in `tags` that no drive has."""
    share = str(LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING)
    create_counted_views(con)
    event = statement("fleet/event", of=COUNTED_PREFIX, least_share=share)
    (totals,) = con.execute(statement("fleet/totals")).to_arrow_table().to_pylist()
    (touched,) = con.execute(statement("audit/contacts", event=event)).fetchall()
    worst = query_rows(
        con,
        "worst",
        {"most": MAX_DRIVES_PER_TABLE},
        least_share=share,
        ranked=ranked_drives_sql(),
        event=event,
        gravest_first=severity_order_sql(),
        options=options_column_sql(con),
    )
    for row in worst:
        row["command"] = check_command(row["log"], row["options"], audit.settings, row["drive_id"])
        row["explain"] = shlex.join(["drivelint", "explain", row["finding_id"], "--in", f"drives/{row['drive_id']}"])
        row["tags"] = dict(row["tags"] or ())
    rules = {row["rule_id"]: row for row in con.execute("FROM rules ORDER BY ALL").to_arrow_table().to_pylist()}
    all_rates = sorted(rates(con), key=lambda rate: _sort_key_by_severity(rate, rules))
    (with_findings,) = query_rows(con, "with_findings", subject=counted_egos_sql())
    return FleetContent(
        audit=audit,
        totals=totals,
        severities={row["severity"]: row for row in query_rows(con, "severities", event=event)},
        verdicts=verdict_counts(con, COUNTED_PREFIX),
        rules=rules,
        rates=all_rates,
        axis=logarithmic_axis(rate.per_100km for rate in all_rates if rate.findings),
        worst=worst,
        n_drives_with_findings=with_findings["drives"],
        n_without_rate=with_findings["without_rate"],
        contacts=touched,
        not_judged=query_rows(con, "not_judged", {"most": MAX_DRIVES_PER_TABLE}),
        lossy=logs_with_flag(con, "lossy"),
        off_map=logs_with_flag(con, "off_map"),
        worst_value=worst_tag_value(con, all_rates),
        by_tag=[rates_by_tag(con, tag) for tag in dict.fromkeys(tags)],
        coverage=coverage(con),
        undecided=missing_signals(con),
        places=finding_map(con),
        baseline=None if base is None else difference(con, audit, base, MAX_FINDINGS_PER_STANDING),
    )


def _sort_key_by_severity(rate: Rate, rules: dict[str, Row]) -> tuple[Any, ...]:
    rule = rules[rate.rule_id]
    severity = SEVERITIES.index(rule["severity"]), CONTACT_TAG not in rule["tags"]
    n = rate.findings + rate.findings_of_unknown
    return (not n, severity, -(rate.per_100km.rate or 0.0), -n, rate.rule_id, rate.profile or "")
