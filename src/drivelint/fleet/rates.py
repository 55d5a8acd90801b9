"""Rates of a fleet: findings per 100 km and per hour, failures per occasion and per ego, each with its interval.

**Which denominator.** A rate counts only subjects that were wholly judged. A subject (an ego in a drive) whose verdicts of a rule have an
unknown or an error, or that was judged at a part of its steps only, gives neither its findings nor its exposure to the rate of this rule:
both stand beside it. Three other ways would be wrong:

* to count its exposure: what was not seen would count as kept, and the rate would be too low;
* to count its findings alone: the rate would be too high;
* to leave it out only if it has no finding: one finding is enough to fail, while a pass needs every step. The outcome would decide what
  is counted, and the rate would be too high.

The rate is then that of the subjects that could be judged. It is the rate of the whole fleet if subjects that could not be judged behaved
like the others. Nothing in the tables can show that; `at_least_per_100km` needs no such assumption.

Exposure is the way and time with the automated driver, as rules judge nothing else. Of subjects that are not wholly judged it is all of
their way: where it is not known who drove, all of it may count.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from drivelint.errors import UsageError
from drivelint.fleet import intervals
from drivelint.fleet.distinct_logs import subject
from drivelint.fleet.situations import SITUATIONS, bound_tag, value_of
from drivelint.phrases import hint
from drivelint.result.certainty import LEAST_SHARE
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

    from drivelint.fleet.intervals import Estimate

OTHER_PREFIX: Final = "other_"
"""What the names of the second audit's views begin with."""


@dataclass(frozen=True)
class Rate:
    """The results of a rule at one value of a tag. `tag_value` is None for drives that do not have the tag, and without a tag.

    `egos_*`: subjects that were wholly judged; of these, with a failed verdict; not wholly judged; where the rule was never in force
    (another nation, other conditions, or the automated driver never drove). `drives_not_judged`: their way is not known at all.
    `km`, `hours`, `findings`: of the subjects that were wholly judged. `findings_possible`: of all findings those that are not sure.
    `events_sure`: all the others, where a touch of two egos, which is a finding of each, counts once.
    `occasions`: verdicts that passed or failed, judged at each of their steps, in whatever subject; `occasions_partly`: at a part of them.
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
        """Findings per 100 km."""
        return intervals.poisson(self.findings, self.km / 100)

    @property
    def per_hour(self) -> Estimate:
        """Findings per hour."""
        return intervals.poisson(self.findings, self.hours)

    @property
    def per_occasion(self) -> Estimate:
        """Failed occasions per occasion."""
        return intervals.binomial(self.occasions_failed, self.occasions)

    @property
    def per_ego(self) -> Estimate:
        """Egos that failed, of those wholly judged: several findings of one ego count once, so they need not be independent."""
        return intervals.binomial(self.egos_failed, self.egos_judged)

    @property
    def at_least_per_100km(self) -> float | None:
        """The lower end of the rate over all exposure, if nothing more happened where it was not judged; None: there is no exposure.

        It stands on `events_sure`: what is only possible may not have happened, and one touch is no two.
        """
        found = intervals.poisson(self.events_sure, (self.km + self.km_unknown) / 100)
        return None if found.rate is None else found.low


def rates(
    con: duckdb.DuckDBPyConnection, by: str | None = None, *, of: str = "", without: str | None = None
) -> list[Rate]:
    """Return one rate per rule, profile and value of `by`, in that order; a rule that a drive was not judged by counts nothing of it.

    `by`: a tag, or a situation of `situations.SITUATIONS`. `of`: what the names of the audit's views begin with. `without`: the same of
    another audit; logs that are in it, too, are left out. Errors: `UsageError` if no drive has that tag.
    """
    check_tag(con, by, of)
    left_out = "" if without is None else f"ANTI JOIN {without}drives o ON o.sha256 = d.sha256"
    fragments = {"of": of, "value": value_of(by), "without": left_out, "least_share": str(LEAST_SHARE)}
    parts = {name: statement(f"fleet/{name}", **fragments) for name in ("profiled", "event")}
    parts["subject"] = subject(of, by, left_out)
    rows = con.execute(statement("fleet/rates", **fragments, **parts), bound_tag(by))
    names = [column[0] for column in rows.description or ()]
    return [Rate(**dict(zip(names, row, strict=True))) for row in rows.fetchall()]


def check_tag(con: duckdb.DuckDBPyConnection, by: str | None, of: str) -> None:
    """Refuse a tag that no drive has: all would be of unknown value."""
    if by is None or by in SITUATIONS:  # that no drive has one is an answer
        return
    if (
        con.execute(f"SELECT 1 FROM {of}drives d WHERE {value_of(by)} IS NOT NULL LIMIT 1", {"by": by}).fetchone()
        is None
    ):
        tags = con.execute(f"SELECT DISTINCT unnest(map_keys(tags)) FROM {of}drives ORDER BY ALL").fetchall()
        raise UsageError(f"no drive has the tag {by!r}; {hint(by, [*(tag for (tag,) in tags), *SITUATIONS])}")
