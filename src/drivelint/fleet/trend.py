"""Tests whether the rate of a rule rises or falls over several audits, by an exact test and a correction for many rules."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.fleet.intervals import holm_corrected
from drivelint.fleet.rate_change import ALLOWED_FALSE_CALL_PROBABILITY

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.arrays import Floats
    from drivelint.fleet.rates import Rate

MAX_EXACT_EVENTS: Final = 500
"""Up to this number of events the p-value is exact; above it, the normal approximation of the same statistic is used."""
_EQUAL_CHANCE_FACTOR: Final = 1 + 1e-7
"""Chances that differ by less are equal: they are sums of floating-point numbers, and those of mirrored outcomes must both count."""


@dataclass(frozen=True)
class Trend:
    """The rates of a rule and profile in several audits, in the given order. `rates`: one per audit; None: its rules lack this one.

    `p_value`: the chance of a trend like this or a rarer one, if the rate is the same in all audits; None: fewer than two audits have
    an exposure. `corrected`: the same, corrected for all tests; None: without an event there is no test.
    """

    rule_id: str
    profile: str | None
    rates: tuple[Rate | None, ...]
    p_value: float | None
    corrected: float | None

    @property
    def n_findings(self) -> int:
        """The findings that the rates count, of all audits."""
        return sum(rate.findings for rate in self.rates if rate is not None)

    @property
    def is_significant(self) -> bool:
        """Whether the rate rises or falls, if at most 5 % of such lists may contain a false call."""
        return self.corrected is not None and self.corrected <= ALLOWED_FALSE_CALL_PROBABILITY

    @property
    def is_rising(self) -> bool:
        """Whether the later audits have more findings than the same rate for all would give."""
        events, exposures = _findings_and_km(self.rates)
        steps = np.arange(len(events), dtype=float)
        return bool(steps @ events > (steps @ exposures) / exposures.sum() * events.sum())


def trends(audits: Sequence[Sequence[Rate]]) -> list[Trend]:
    """Return the trend of each rule and profile, in the order of their names. `audits`: the rates of each audit, in the order of time.

    The audits must not share logs: the test assumes that their counts are independent. Like the intervals, it assumes that events occur
    independently of each other.
    """
    by_audit = [{(rate.rule_id, rate.profile): rate for rate in rates} for rates in audits]
    names = sorted({name for rates in by_audit for name in rates}, key=lambda name: (name[0], name[1] or ""))
    rows = [tuple(rates.get(name) for rates in by_audit) for name in names]
    values = [_p_value_of_rates(row) for row in rows]
    tested = [n for n, row in enumerate(rows) if values[n] is not None and _findings_and_km(row)[0].any()]
    corrected = dict(zip(tested, holm_corrected([values[n] or 0.0 for n in tested]), strict=True))
    return [
        Trend(*name, row, values[n], corrected.get(n)) for n, (name, row) in enumerate(zip(names, rows, strict=True))
    ]


def trend_p_value(events: Sequence[int], exposures: Sequence[float]) -> float:
    """Return the two-sided p-value of a trend of Poisson rates over equally spaced steps, given the sum of the events.

    The statistic is that of Cochran (1954) and Armitage (1955): the sum over the events of their step. If all steps have one rate, each
    event falls into a step with the share of its exposure. Of two steps it is the binomial test. A step without an exposure has no event.
    """
    n = int(sum(events))
    shares = np.asarray(exposures, float) / float(sum(exposures))
    steps = np.arange(len(shares), dtype=float)
    observed = int(steps @ np.asarray(events))
    if n == 0:
        return 1.0
    if n > MAX_EXACT_EVENTS:
        return _normal_p_value(observed, n, shares)
    chances = _probability_of_each_sum_of_event_steps(shares, n)
    return float(min(1.0, chances[chances <= chances[observed] * _EQUAL_CHANCE_FACTOR].sum()))


def _probability_of_each_sum_of_event_steps(shares: Floats, n_events: int) -> Floats:
    """Return the chance of each sum of the steps of `n_events` events: that power of the polynomial of the shares."""
    power, chances = shares, np.ones(1)
    while n_events:
        if n_events & 1:
            chances = np.convolve(chances, power)
        n_events >>= 1
        if n_events:
            power = np.convolve(power, power)
    return chances


def _normal_p_value(observed: int, n_events: int, shares: Floats) -> float:
    from scipy.stats import norm

    steps = np.arange(len(shares), dtype=float)
    mean = float(steps @ shares)
    spread = (n_events * (float(steps**2 @ shares) - mean**2)) ** 0.5
    # half a step towards the mean, as the sum is a whole number
    return float(min(1.0, 2 * norm.sf(max(0.0, abs(observed - n_events * mean) - 0.5) / spread)))


def _p_value_of_rates(rates: Sequence[Rate | None]) -> float | None:
    events, exposures = _findings_and_km(rates)
    if np.count_nonzero(exposures) < 2:
        return None
    return trend_p_value(events.astype(int).tolist(), exposures.tolist())


def _findings_and_km(rates: Sequence[Rate | None]) -> tuple[Floats, Floats]:
    """Return findings and km of each audit; 0 where an audit does not have the rule."""
    pairs = [(0.0, 0.0) if rate is None else (float(rate.findings), rate.km) for rate in rates]
    events, exposures = np.array(pairs, float).reshape(-1, 2).T
    return np.where(exposures > 0, events, 0.0), exposures
