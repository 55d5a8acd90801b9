"""Tests whether the rates of two audits differ, per km and per occasion, with exact tests and a correction for many tests."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint.fleet.intervals import holm_corrected
from drivelint.fleet.rates import OTHER_AUDIT_VIEW_PREFIX, rates

if TYPE_CHECKING:
    from collections.abc import Sequence

    import duckdb

    from drivelint.fleet.intervals import Estimate
    from drivelint.fleet.rates import Rate

ALLOWED_FALSE_CALL_PROBABILITY: Final = 0.05
"""The allowed probability that any rule is reported although no rate differs."""


class RateTest(NamedTuple):
    """One test of a rule's rates, per 100 km or per occasion. `events`, `of`, `rates`: the events, exposures and rates of both audits, the
    base's first.

    `p_value`: the probability of this difference or a less likely one, if the rates are equal. `corrected`: the p-value corrected for all
    tests that could report a difference.
    """

    per: str
    events: tuple[int, int]
    of: tuple[float, float]
    rates: tuple[Estimate, Estimate]
    p_value: float
    corrected: float

    @property
    def ratio(self) -> float | None:
        """The new rate divided by the base's rate; infinite if the base has no event."""
        base, new = (rate.rate or 0.0 for rate in self.rates)
        return inf if base == 0 else new / base

    @property
    def is_significant(self) -> bool:
        """Whether the test reports a difference. The probability of any false report in all tests together is at most 5 %."""
        return self.corrected <= ALLOWED_FALSE_CALL_PROBABILITY


@dataclass(frozen=True)
class RateChange:
    """The rates of a rule in two audits. `base`, `new`: rates over the logs that only one audit has; None: there are no such logs.

    `p_value`: of findings per km. `occasion_p_value`: of failed occasions. None: one audit has no exposure, or no occasion.
    `corrected`, `occasion_corrected`: the same, corrected for all tests; None: neither audit has an event, so no test can report a
    difference.
    """

    rule_id: str
    profile: str | None
    tag_value: str | None
    base: Rate | None
    new: Rate | None
    p_value: float | None
    corrected: float | None
    occasion_p_value: float | None = None
    occasion_corrected: float | None = None

    @property
    def is_significant(self) -> bool:
        """Whether any test reports a difference. The probability of any false report for all rules together is at most 5 %."""
        return any(test.is_significant for test in self.tests)

    @property
    def tests(self) -> list[RateTest]:
        """The tests of this rule that could report a difference."""
        if self.base is None or self.new is None:
            return []
        sides = (self.base, self.new)
        results = []
        if self.p_value is not None and self.corrected is not None:
            numbers = [(side.findings, side.km, side.per_100km) for side in sides]
            results.append(_rate_test("100 km", numbers, self.p_value, self.corrected))
        if self.occasion_p_value is not None and self.occasion_corrected is not None:
            numbers = [(side.occasions_failed, float(side.occasions), side.per_occasion) for side in sides]
            results.append(_rate_test("occasion", numbers, self.occasion_p_value, self.occasion_corrected))
        return results


def _rate_test(per: str, sides: list[tuple[int, float, Estimate]], p_value: float, corrected: float) -> RateTest:
    (n, of, rate), (n_new, of_new, rate_new) = sides
    return RateTest(per, (n, n_new), (of, of_new), (rate, rate_new), p_value, corrected)


def compare_rates(
    con: duckdb.DuckDBPyConnection, by: str | None = None, *, base: str = "", new: str = OTHER_AUDIT_VIEW_PREFIX
) -> list[RateChange]:
    """Return, for each rule, profile and value of a tag, whether its rate differs between two audits.

    Only logs that just one audit has are counted. For logs in both audits, `compare` already gives every difference of findings: chance
    plays no part, and a test for independent samples would be wrong.
    """
    sides = rates(con, by, of=base, without=new), rates(con, by, of=new, without=base)
    return rate_changes(*sides)


def rate_changes(base: Sequence[Rate], new: Sequence[Rate]) -> list[RateChange]:
    """Return the changes of these rates in the order of their names. The exposures of both sides must be independent.

    The tests are exact, conditional on the total number of events. If findings per km are equal, each finding falls into the new audit with
    the probability of the new audit's share of the exposure. For the shares of failed occasions, Fisher's test is used. Like the intervals,
    the tests assume that events occur independently. Where neither audit has an event, no test can report a difference, so the correction
    leaves these tests out.
    """
    had, has = ({(rate.rule_id, rate.profile, rate.tag_value): rate for rate in side} for side in (base, new))
    names = sorted(had.keys() | has.keys(), key=lambda name: tuple((part is not None, part or "") for part in name))
    values: dict[tuple[Any, str], float] = {}
    for name in names:
        sides = had.get(name), has.get(name)
        for per, p_value in (("km", _p_value_per_km(*sides)), ("occasion", _p_value_per_occasion(*sides))):
            if p_value is not None:
                values[name, per] = p_value
    able = [key for key in values if _has_any_event(had[key[0]], has[key[0]], key[1])]
    corrected = dict(zip(able, holm_corrected([values[key] for key in able]), strict=True))
    return [
        RateChange(
            *name,
            had.get(name),
            has.get(name),
            values.get((name, "km")),
            corrected.get((name, "km")),
            values.get((name, "occasion")),
            corrected.get((name, "occasion")),
        )
        for name in names
    ]


def _has_any_event(base: Rate, new: Rate, per: str) -> bool:
    return bool(base.findings + new.findings if per == "km" else base.occasions_failed + new.occasions_failed)


def _p_value_per_km(base: Rate | None, new: Rate | None) -> float | None:
    from scipy.stats import binomtest

    if base is None or new is None or base.km <= 0 or new.km <= 0:
        return None
    findings = base.findings + new.findings
    if not findings:
        return 1.0
    return float(binomtest(new.findings, findings, new.km / (base.km + new.km)).pvalue)


def _p_value_per_occasion(base: Rate | None, new: Rate | None) -> float | None:
    from scipy.stats import fisher_exact

    if base is None or new is None or not base.occasions or not new.occasions:
        return None
    table = [[rate.occasions_failed, rate.occasions - rate.occasions_failed] for rate in (base, new)]
    return float(fisher_exact(table)[1])
