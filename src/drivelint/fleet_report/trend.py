"""`drivelint trend`: the rates of several audits beside each other, in the order of time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import msgspec

from drivelint.errors import ExitCode, UsageError
from drivelint.fleet.distinct_logs import COUNTED_PREFIX, create_counted_views
from drivelint.fleet.rates import rates
from drivelint.fleet.trend import Trend, trends
from drivelint.fleet_report.audit_views import open_audit_leaving_out_logs
from drivelint.fleet_report.difference_text import rate_name
from drivelint.fleet_report.figures import number_text
from drivelint.fleet_report.rows import finding_per_event_sql, query_rows
from drivelint.phrases import one_line, plural
from drivelint.report.markdown import escape_markdown, markdown_code
from drivelint.result.counts import SEVERITIES
from drivelint.result.text import NO_VALUE, replace_non_finite
from drivelint.result.text_templates import text_template
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import duckdb

    from drivelint.fleet.rates import Rate

TREND_SCHEMA_VERSION: Final = 1
"""Version of the JSON: raised when a key changes its meaning or is removed."""


class AuditTotals(NamedTuple):
    """The counts of an audit without the logs that an earlier audit has. `n_left_out`: drives of such logs.

    `findings`: severity -> events. `warning`: why the counts are not complete; empty: they are.
    """

    name: str
    n_drives: int
    n_judged: int
    km: float
    hours: float
    findings: dict[str, int]
    n_left_out: int
    warning: str


@dataclass(frozen=True)
class AuditTrend:
    """Several audits in the order of time. `trends`: of the rules with a finding, those nearest to a trend first."""

    audits: list[AuditTotals]
    trends: list[Trend]
    n_rules_without_findings: int
    n_tests: int

    @property
    def significant_trends(self) -> list[Trend]:
        """The rules whose rate rises or falls by more than chance explains."""
        return [trend for trend in self.trends if trend.is_significant]

    @property
    def headline(self) -> str:
        """What the tests found, in one sentence."""
        if not self.n_tests:
            return "no rule has a finding and a rate in two of the audits: there is nothing to compare"
        parts = [f"{rate_name(trend)} {direction(trend)}" for trend in self.significant_trends]
        changes = ", ".join(parts) if parts else "no rate rises or falls"
        return f"{changes} by more than chance explains ({plural(self.n_tests, 'test')}, Holm's correction)"

    @property
    def exit_code(self) -> ExitCode:
        """NOT_JUDGED if an audit has not ended, or if there is no rate to compare; else OK. A trend is a fact and no failure."""
        return ExitCode.NOT_JUDGED if not self.n_tests or any(audit.warning for audit in self.audits) else ExitCode.OK


def audit_trend(dests: Sequence[str], warn: Callable[[str], None]) -> AuditTrend:
    """Return the trend of several audits. A log that several audits have counts in the first of them.

    `warn`: called with a sentence for each audit that has not ended. Errors: `UsageError` for fewer than two audits, or where no audit is.
    """
    if len(dests) < 2:
        raise UsageError("a trend needs at least two audits, in the order of time")
    totals: list[AuditTotals] = []
    rates_by_audit: list[list[Rate]] = []
    known_hashes: list[str] = []
    for dest in dests:
        with open_audit_leaving_out_logs(dest, known_hashes) as (con, audit, n_left_out):
            if audit.warning:
                warn(audit.warning)
            totals.append(_audit_totals(con, audit.name, n_left_out, audit.warning))
            rates_by_audit.append(rates(con))
            hashes = con.execute("SELECT DISTINCT sha256 FROM drives WHERE sha256 IS NOT NULL ORDER BY ALL").fetchall()
            known_hashes += [sha256 for (sha256,) in hashes]
    all_trends = trends(rates_by_audit)
    with_findings = [
        trend for trend in all_trends if any(rate and rate.findings + rate.findings_of_unknown for rate in trend.rates)
    ]
    return AuditTrend(
        totals,
        sorted(with_findings, key=_sort_key_by_p_value),
        len(all_trends) - len(with_findings),
        sum(trend.corrected is not None for trend in all_trends),
    )


def direction(trend: Trend) -> str:
    """Return whether a rate rises or falls, as a verb."""
    return "rises" if trend.is_rising else "falls"


def _audit_totals(con: duckdb.DuckDBPyConnection, name: str, n_left_out: int, warning: str) -> AuditTotals:
    create_counted_views(con)
    (of,) = con.execute(statement("fleet/totals")).to_arrow_table().to_pylist()
    by_severity = {
        row["severity"]: row["findings"]
        for row in query_rows(con, "severities", event=finding_per_event_sql(COUNTED_PREFIX))
    }
    findings = {severity: by_severity.get(severity, 0) for severity in SEVERITIES}
    return AuditTotals(name, of["drives"], of["judged"], of["km"], of["hours"], findings, n_left_out, warning)


def _sort_key_by_p_value(trend: Trend) -> tuple[bool, float, int, str, str]:
    chance = trend.p_value
    return chance is None, chance or 0.0, -trend.n_findings, trend.rule_id, trend.profile or ""


def rate_text(rate: Rate | None) -> str:
    """Return findings per 100 km and their number; those of egos that were not wholly judged after a plus."""
    if rate is None or rate.per_100km.rate is None:
        return NO_VALUE
    more = f"+{rate.findings_of_unknown}" if rate.findings_of_unknown else ""
    return f"{number_text(rate.per_100km.rate)} ({rate.findings}{more})"


def trend_text(trend: Trend) -> str:
    """Return the result of the test of a rule: its direction if it is called, p and the corrected p."""
    if trend.p_value is None or trend.corrected is None:
        return "no test"
    word = direction(trend) if trend.is_significant else "no trend"
    return f"{word}, p {number_text(trend.p_value)}, corrected {number_text(trend.corrected)}"


def to_text(trend: AuditTrend, *, markdown: bool = False) -> str:
    """Return a trend as text for a person, or as Markdown."""
    filters: dict[str, Any] = {
        "figure": number_text,
        "rate_name": rate_name,
        "rate_text": rate_text,
        "trend_text": trend_text,
        "escaped": escape_markdown,
        "code": markdown_code,
    }
    name = f"templates/trend.{'md' if markdown else 'txt'}.j2"
    table = None if markdown else _text_tables(trend)
    text = text_template(__file__, name, None, **filters).render(trend=trend, severities=SEVERITIES, table=table)
    return text.rstrip("\n")


def _text_tables(trend: AuditTrend) -> dict[str, list[str]]:
    """Return the lines of both tables of the text, with columns of equal width."""
    head = ["audit", "drives", "judged", "km", "hours", *SEVERITIES]
    counts = [
        [
            one_line(of.name),
            str(of.n_drives),
            str(of.n_judged),
            number_text(of.km),
            number_text(of.hours),
            *map(str, of.findings.values()),
        ]
        for of in trend.audits
    ]
    names = ["rule", *(one_line(of.name) for of in trend.audits), "trend"]
    lines = [
        [rate_name(rule_trend), *map(rate_text, rule_trend.rates), trend_text(rule_trend)]
        for rule_trend in trend.trends
    ]
    return {"audits": _aligned_lines([head, *counts]), "rules": _aligned_lines([names, *lines])}


def _aligned_lines(cells: list[list[str]]) -> list[str]:
    """Return one line per row: the first column on the left, the others on the right."""
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    return [
        "  ".join(
            cell.ljust(width) if n == 0 else cell.rjust(width)
            for n, (cell, width) in enumerate(zip(row, widths, strict=True))
        )
        for row in cells
    ]


def to_json(trend: AuditTrend) -> str:
    """Return a trend as JSON: the counts of each audit, and every rule with a finding, its rates and its test."""
    content = {
        "trend_schema": TREND_SCHEMA_VERSION,
        "exit": {"code": int(trend.exit_code), "why": trend.headline},
        "audits": [audit._asdict() for audit in trend.audits],
        "rules": [
            {
                "rule_id": rule_trend.rule_id,
                "profile": rule_trend.profile,
                "p_value": rule_trend.p_value,
                "corrected": rule_trend.corrected,
                "called": rule_trend.is_significant,
                "direction": direction(rule_trend) if rule_trend.is_significant else None,
                "rates": [
                    rate
                    and {
                        "findings": rate.findings,
                        "findings_of_unknown": rate.findings_of_unknown,
                        "km": rate.km,
                        "km_unknown": rate.km_unknown,
                        "per_100km": rate.per_100km._asdict(),
                    }
                    for rate in rule_trend.rates
                ],
            }
            for rule_trend in trend.trends
        ],
        "rules_without_findings": trend.n_rules_without_findings,
    }
    return msgspec.json.format(msgspec.json.encode(replace_non_finite(msgspec.to_builtins(content))), indent=2).decode()
