"""Formats rates, intervals and large numbers as text, and computes the bars that show intervals."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from drivelint.report.html.svg import percent
from drivelint.result.text import NO_VALUE

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.fleet.intervals import Estimate
    from drivelint.fleet.rates import Rate


def number_text(value: float | None) -> str:
    """Return a number with three significant digits; a dash for None."""
    if value is None:
        return NO_VALUE
    if value == 0 or not math.isfinite(value):
        return "0" if value == 0 else "no limit"
    if abs(value) >= 1000:
        return f"{value:,.0f}"
    digits = max(0, 2 - math.floor(math.log10(abs(value))))
    return f"{value:.{digits}f}" if digits < 8 else f"{value:.2e}"


def rate_with_interval(estimate: Estimate) -> str:
    """Return a rate with the bounds of its interval as text; a dash if the rate is not known."""
    if estimate.rate is None:
        return NO_VALUE
    return f"{number_text(estimate.rate)} ({number_text(estimate.low)} to {number_text(estimate.high)})"


def lower_bound_instead_of_zero(rate: Rate) -> tuple[str, str] | None:
    """Return a lower bound and an explanation, to show instead of a rate of 0 that leaves findings out; None: for any other rate.

    The drives with these findings were not completely judged, so they do not count for the rate. A rate of 0 would look as if nothing had
    happened.
    """
    if rate.findings or not rate.findings_of_unknown or not rate.at_least_per_100km:
        return None
    return (
        f"at least {number_text(rate.at_least_per_100km)}",
        f"over all km; fully judged: {rate_with_interval(rate.per_100km)}",
    )


def percent_with_interval(estimate: Estimate) -> str:
    """Return a share and its interval in percent as text; a dash if the share is not known."""
    if estimate.rate is None:
        return NO_VALUE
    return f"{number_text(100 * estimate.rate)} % ({number_text(100 * estimate.low)} to {number_text(100 * estimate.high)})"


class LogarithmicAxis(NamedTuple):
    """A logarithmic axis of rates, from 10^`low` at 0 % to 10^`high` at 100 %."""

    low: int
    high: int

    @property
    def range_text(self) -> str:
        """The first and the last value of the axis as text."""
        return f"{10.0**self.low:g} to {10.0**self.high:g}"

    def percent_at(self, value: float) -> float:
        """Return the position of a rate on the axis in percent; a rate of 0 is at the left end."""
        if value <= 0:
            return 0.0
        return min(100.0, max(0.0, 100 * (math.log10(value) - self.low) / (self.high - self.low)))

    def bar(self, estimate: Estimate) -> dict[str, str] | None:
        """Return the position and width of an interval's bar, and the position of the rate; None: the rate is not known."""
        if estimate.rate is None:
            return None
        low, high = self.percent_at(estimate.low), self.percent_at(estimate.high)
        return {"x": percent(low), "w": percent(max(0.5, high - low)), "rate": percent(self.percent_at(estimate.rate))}


def logarithmic_axis(estimates: Iterable[Estimate]) -> LogarithmicAxis:
    """Return an axis that includes these rates and the finite bounds of their intervals."""
    known_estimates = [estimate for estimate in estimates if estimate.rate is not None]
    ends = [
        end
        for estimate in known_estimates
        for end in (estimate.low, estimate.rate, estimate.high)
        if end and math.isfinite(end)
    ]
    if not ends:
        return LogarithmicAxis(-1, 1)
    low, high = math.floor(math.log10(min(ends))), math.ceil(math.log10(max(ends)))
    return LogarithmicAxis(low, max(high, low + 1))
