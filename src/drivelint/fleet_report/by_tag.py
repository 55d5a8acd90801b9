"""Computes rates of an audit by the values of a tag, for the values that most drives have."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.fleet.rates import rates
from drivelint.fleet.situations import MEASURED_SITUATIONS, parameters_of_tag, tag_or_situation_sql
from drivelint.fleet_report.figures import logarithmic_axis
from drivelint.result.counts import SEVERITIES
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

    from drivelint.fleet.rates import Rate
    from drivelint.fleet_report.figures import LogarithmicAxis

MAX_TAG_VALUES: Final = 12
MAX_SHOWN_RULES: Final = 12
_SHOWN_DRIVES_VIEW_PREFIX: Final = "shown_"


class RuleRatesByTag(NamedTuple):
    """The rates of one rule and profile, one per value of the tag. The rate of drives without the tag is last."""

    rule_id: str
    profile: str | None
    rates: list[Rate]


@dataclass(frozen=True)
class RatesByTag:
    """The rates of the most severe and most frequently broken rules by one tag, on a common axis of findings per 100 km.

    `n_values_left_out`: number of less frequent values. `n_rules_left_out`: number of other rules with findings; `n_findings_left_out`:
    number of their findings.
    """

    tag: str
    rules: list[RuleRatesByTag]
    axis: LogarithmicAxis
    n_values_left_out: int
    n_rules_left_out: int
    n_findings_left_out: int


def rates_by_tag(con: duckdb.DuckDBPyConnection, tag: str) -> RatesByTag:
    """Return the rates by a tag or a situation. Errors: `UsageError` if no drive has that tag."""
    n_values, of = 0, ""
    if tag not in MEASURED_SITUATIONS:  # measured situations have few values, and belong to an ego
        con.execute(
            statement("fleet_report/tag_values", value=tag_or_situation_sql(tag)),
            {**parameters_of_tag(tag), "most": MAX_TAG_VALUES},
        )
        n_values = con.execute("SELECT max(n_values) FROM shown_value").fetchall()[0][0] or 0
        if n_values > MAX_TAG_VALUES:
            con.execute(statement("fleet_report/tag_drives", value=tag_or_situation_sql(tag)), parameters_of_tag(tag))
            for table in ("drives", "verdicts", "findings"):
                con.execute(
                    f"CREATE OR REPLACE TEMP VIEW {_SHOWN_DRIVES_VIEW_PREFIX}{table} AS FROM {table} SEMI JOIN shown_key USING (key)"
                )
            con.execute(f"CREATE OR REPLACE TEMP VIEW {_SHOWN_DRIVES_VIEW_PREFIX}rules AS FROM rules")
            of = _SHOWN_DRIVES_VIEW_PREFIX
    by_rule: dict[tuple[str, str | None], list[Rate]] = {}
    for rate in rates(con, tag, of=of):
        by_rule.setdefault((rate.rule_id, rate.profile), []).append(rate)
    rule_rates = [
        RuleRatesByTag(*name, sorted(group, key=lambda r: r.tag_value is None)) for name, group in by_rule.items()
    ]
    severity = dict(con.execute("SELECT rule_id, severity FROM rules").fetchall())
    rule_rates = sorted(
        (rule for rule in rule_rates if _n_findings(rule)),
        key=lambda rule: (
            SEVERITIES.index(severity[rule.rule_id]),
            -_n_findings(rule),
            rule.rule_id,
            rule.profile or "",
        ),
    )
    left = rule_rates[MAX_SHOWN_RULES:]
    return RatesByTag(
        tag,
        rule_rates[:MAX_SHOWN_RULES],
        logarithmic_axis(rate.per_100km for rule in rule_rates[:MAX_SHOWN_RULES] for rate in rule.rates),
        max(0, n_values - MAX_TAG_VALUES),
        len(left),
        sum(map(_n_findings, left)),
    )


def _n_findings(rule: RuleRatesByTag) -> int:
    return sum(rate.findings + rate.findings_of_unknown for rate in rule.rates)
