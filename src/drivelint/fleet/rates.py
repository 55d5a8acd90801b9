"""Computes rates of a fleet: findings per 100 km and per hour, failures per occasion and per ego, each with its confidence interval.

**Which denominator.** A subject is an ego in a drive. A rate of a rule counts only subjects that were completely judged. A subject is left
out, with its findings and exposure, if the rule has an unknown or error verdict or judged only some steps. These findings and this exposure
are reported beside the rate. Three other methods would be wrong:

* Counting the exposure of such a subject: what was not judged would count as kept, and the rate would be too low.
* Counting only the findings of such a subject: the rate would be too high.
* Leaving the subject out only if it has no finding: one finding is enough to fail, while a pass needs every step. The outcome would then
  determine what is counted, and the rate would be too high.

The result is the rate of the subjects that could be judged. It equals the rate of the whole fleet if the other subjects behaved the same.
The tables cannot show that; `at_least_per_100km` needs no such assumption.

Exposure is the distance and time driven by the automated driver, as rules judge nothing else. For subjects that were not completely judged,
it is their whole distance and time, because the driver may be unknown.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from drivelint.errors import UsageError
from drivelint.fleet import intervals
from drivelint.fleet.distinct_logs import counted_egos_sql
from drivelint.fleet.situations import SITUATIONS, parameters_of_tag, tag_or_situation_sql
from drivelint.phrases import hint
from drivelint.result.certainty import LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

    from drivelint.fleet.intervals import Estimate

OTHER_AUDIT_VIEW_PREFIX: Final = "other_"
"""The prefix of the second audit's views."""


@dataclass(frozen=True)
class Rate:
    """The results of a rule at one value of a tag. `tag_value` is None for drives without the tag, and if no tag was given.

    `egos_judged`: completely judged subjects; `egos_failed`: how many of these have a failed verdict; `egos_unknown`: subjects that were
    not completely judged. `egos_outside`: subjects for which the rule was never in force (another nation, other conditions, or no automated
    driver). `drives_not_judged`: their distance is unknown.
    `km`, `hours`, `findings`: of completely judged subjects. `findings_possible`: how many of all findings are only possible.
    `events_sure`: number of all other findings; a contact of two egos, which is a finding of each, counts once.
    `occasions`: verdicts that passed or failed and were judged at all their steps, of all subjects. `occasions_partly`: those that were
    judged at some of their steps.
    """

    rule_id: str
    profile: str | None
    tag_value: str | None
    egos_judged: int
    egos_failed: int
    egos_unknown: int
    egos_outside: int
    drives_not_judged: int
    km: float
    hours: float
    km_unknown: float
    hours_unknown: float
    findings: int
    findings_of_unknown: int
    findings_possible: int
    events_sure: int
    occasions: int
    occasions_failed: int
    occasions_partly: int
    n_pass: int
    n_fail: int
    n_unknown: int
    n_not_applicable: int
    n_error: int

    @property
    def per_100km(self) -> Estimate:
        """The rate of findings per 100 km."""
        return intervals.poisson_rate(self.findings, self.km / 100)

    @property
    def per_hour(self) -> Estimate:
        """The rate of findings per hour."""
        return intervals.poisson_rate(self.findings, self.hours)

    @property
    def per_occasion(self) -> Estimate:
        """The share of occasions that failed."""
        return intervals.binomial_rate(self.occasions_failed, self.occasions)

    @property
    def per_ego(self) -> Estimate:
        """The share of completely judged egos that failed. Several findings of an ego count once, so they need not be independent."""
        return intervals.binomial_rate(self.egos_failed, self.egos_judged)

    @property
    def at_least_per_100km(self) -> float | None:
        """The lower bound of the rate over all exposure, if nothing more happened where nothing was judged; None: there is no exposure.

        It uses `events_sure`: a possible finding may not have happened, and one contact must not count twice.
        """
        rate = intervals.poisson_rate(self.events_sure, (self.km + self.km_unknown) / 100)
        return None if rate.rate is None else rate.low


def rates(
    con: duckdb.DuckDBPyConnection, by: str | None = None, *, of: str = "", without: str | None = None
) -> list[Rate]:
    """Return one rate per rule, profile and value of `by`, in that order. A drive counts for a rule only if it was judged by this rule.

    `by`: a tag, or a situation of `situations.SITUATIONS`. `of`: prefix of the audit's views. `without`: prefix of another audit's views,
    whose logs are left out. Errors: `UsageError` if no drive has that tag.
    """
    check_tag_exists(con, by, of)
    left_out = "" if without is None else f"ANTI JOIN {without}drives o ON o.sha256 = d.sha256"
    fragments = {
        "of": of,
        "value": tag_or_situation_sql(by),
        "without": left_out,
        "least_share": str(LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING),
    }
    parts = {name: statement(f"fleet/{name}", **fragments) for name in ("profiled", "event")}
    parts["subject"] = counted_egos_sql(of, by, left_out)
    rows = con.execute(statement("fleet/rates", **fragments, **parts), parameters_of_tag(by))
    names = [column[0] for column in rows.description or ()]
    return [Rate(**dict(zip(names, row, strict=True))) for row in rows.fetchall()]


def check_tag_exists(con: duckdb.DuckDBPyConnection, by: str | None, of: str) -> None:
    """Raise `UsageError` if no drive has the tag: every value would be None."""
    if by is None or by in SITUATIONS:  # situations that no drive has are a valid result
        return
    if (
        con.execute(
            f"SELECT 1 FROM {of}drives d WHERE {tag_or_situation_sql(by)} IS NOT NULL LIMIT 1", {"by": by}
        ).fetchone()
        is None
    ):
        tags = con.execute(f"SELECT DISTINCT unnest(map_keys(tags)) FROM {of}drives ORDER BY ALL").fetchall()
        raise UsageError(f"no drive has the tag {by!r}; {hint(by, [*(tag for (tag,) in tags), *SITUATIONS])}")
