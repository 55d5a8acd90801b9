"""Finds the value of a tag at which a rule's findings per km exceed the other values most, over all tags."""

from __future__ import annotations

import shlex
from itertools import groupby
from operator import attrgetter
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.fleet import intervals
from drivelint.fleet.rate_change import ALLOWED_FALSE_CALL_PROBABILITY
from drivelint.fleet.rates import rates
from drivelint.fleet.situations import MEASURED_SITUATIONS
from drivelint.fleet_report.by_tag import MAX_TAG_VALUES
from drivelint.fleet_report.rows import query_rows

if TYPE_CHECKING:
    from collections.abc import Sequence

    import duckdb

    from drivelint.fleet.intervals import Estimate
    from drivelint.fleet.rates import Rate

MAX_COMPARED_TAGS: Final = 6
MAX_COMPARED_RULES: Final = 6
_COMPARED_RULES_VIEW_PREFIX: Final = "compared_"
"""The prefix of the views of the compared rules."""


class WorstTagValue(NamedTuple):
    """A rule's rates by a tag, the highest first, for values with completely judged drives. `rest`: the rate of all values but the first.

    `corrected`: the p-value of the difference, corrected for all `n_tests` comparisons of the values of `n_tags` tags. `n_tags_left_out`:
    number of tags that were not compared, because they have too many values or come after the first tags.
    """

    tag: str
    rates: list[Rate]
    rest: Estimate
    corrected: float
    n_tests: int
    n_tags: int
    n_tags_left_out: int

    @property
    def worst(self) -> Rate:
        """The highest rate."""
        return self.rates[0]

    @property
    def report_option(self) -> str:
        """The option of `report` that shows all rules by the tag, quoted for a shell."""
        return shlex.join(["--by", self.tag])

    @property
    def is_significant(self) -> bool:
        """Whether the difference is significant. The probability of any false report in all comparisons together is at most 5 %."""
        return self.corrected <= ALLOWED_FALSE_CALL_PROBABILITY


class _TagComparison(NamedTuple):
    tag: str
    rates: list[Rate]
    p_value: float


def worst_tag_value(con: duckdb.DuckDBPyConnection, all_rates: Sequence[Rate]) -> WorstTagValue | None:
    """Return the value of a tag whose rate exceeds the others most; None: no tag can be compared.

    `all_rates`: the rates of all drives, the most severe first; the first rules with findings are compared. Only the highest rate of a tag
    and rule can be reported, but the correction counts each value, because each could be the highest by chance.
    """
    ids = list(dict.fromkeys(rate.rule_id for rate in all_rates if rate.findings))[:MAX_COMPARED_RULES]
    all_tags = query_rows(con, "tags")
    compared_tags = [
        row["tag"]
        for row in all_tags
        if 1 < row["n_values"] <= MAX_TAG_VALUES and row["tag"] not in MEASURED_SITUATIONS
    ]
    if not ids or not compared_tags:
        return None
    tags = compared_tags[:MAX_COMPARED_TAGS]
    con.execute("CREATE OR REPLACE TEMP TABLE compared_rule AS SELECT unnest($ids::VARCHAR[]) AS rule_id", {"ids": ids})
    for table in ("verdicts", "findings", "rules"):
        con.execute(
            f"CREATE OR REPLACE TEMP VIEW {_COMPARED_RULES_VIEW_PREFIX}{table} AS FROM {table} SEMI JOIN compared_rule USING (rule_id)"
        )
    con.execute(f"CREATE OR REPLACE TEMP VIEW {_COMPARED_RULES_VIEW_PREFIX}drives AS FROM drives")
    compared, n_tests = [], 0
    for tag in tags:
        by_rule = attrgetter("rule_id", "profile")
        for _, of in groupby(rates(con, tag, of=_COMPARED_RULES_VIEW_PREFIX), by_rule):
            tag_rates = [rate for rate in of if rate.tag_value is not None and rate.km > 0]
            if len(tag_rates) > 1 and any(rate.findings for rate in tag_rates):
                n_tests += len(tag_rates)
                compared.append(_compare_highest_rate(tag, tag_rates))
    if not compared:
        return None
    first = min(
        compared, key=lambda entry: (entry.p_value, entry.tag, entry.rates[0].rule_id, entry.rates[0].profile or "")
    )
    rest = first.rates[1:]
    return WorstTagValue(
        first.tag,
        first.rates,
        intervals.poisson_rate(sum(rate.findings for rate in rest), sum(rate.km for rate in rest) / 100),
        min(1.0, n_tests * first.p_value),
        n_tests,
        len(tags),
        sum(row["n_values"] > 1 for row in all_tags) - len(tags),
    )


def _compare_highest_rate(tag: str, tag_rates: Sequence[Rate]) -> _TagComparison:
    """Compare the highest rate with all others by a binomial test: a finding falls on a value with the probability of the value's share of
    the distance."""
    from scipy.stats import binomtest

    ranked = sorted(tag_rates, key=lambda rate: (-(rate.per_100km.rate or 0.0), -rate.findings, rate.tag_value or ""))
    n, km = sum(rate.findings for rate in ranked), sum(rate.km for rate in ranked)
    return _TagComparison(tag, ranked, float(binomtest(ranked[0].findings, n, ranked[0].km / km).pvalue))
