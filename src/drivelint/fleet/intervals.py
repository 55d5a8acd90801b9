"""Computes rates with exact 95 % confidence intervals, and corrects p-values of several tests."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Sequence

CONFIDENCE: Final = 0.95


class Estimate(NamedTuple):
    """A rate and the bounds of its confidence interval. `rate` is None without exposure."""

    rate: float | None
    low: float
    high: float


def poisson_rate(events: int, exposure: float) -> Estimate:
    """Return events per unit of exposure, with Garwood's exact interval (1936).

    The interval is valid if events are independent. It is too narrow if one failure causes several findings in a drive; the share of egos
    that failed does not have this weakness.
    """
    from scipy.special import gammaincinv

    if exposure <= 0:
        return Estimate(None, 0.0, inf)
    tail = (1 - CONFIDENCE) / 2
    low = float(gammaincinv(events, tail)) if events else 0.0
    return Estimate(events / exposure, low / exposure, float(gammaincinv(events + 1, 1 - tail)) / exposure)


def binomial_rate(events: int, trials: int) -> Estimate:
    """Return events per trial, with the exact interval of Clopper and Pearson (1934)."""
    from scipy.special import betaincinv

    if trials <= 0:
        return Estimate(None, 0.0, 1.0)
    tail = (1 - CONFIDENCE) / 2
    low = float(betaincinv(events, trials - events + 1, tail)) if events else 0.0
    high = float(betaincinv(events + 1, trials - events, 1 - tail)) if events < trials else 1.0
    return Estimate(events / trials, low, high)


def holm_corrected(p_values: Sequence[float]) -> list[float]:
    """Return the p-values corrected by Holm's method (1979), in the same order.

    If no real difference exists, the probability of a corrected value below 0.05 is at most 5 %, even if the rules depend on each other.
    This matters because one event can fail several rules. The method of Benjamini and Hochberg allows more false positives if there are
    more real differences, and assumes no negative dependence between tests.
    """
    corrected = [1.0] * len(p_values)
    least = 0.0
    for rank, n in enumerate(sorted(range(len(p_values)), key=lambda n: (p_values[n], n))):
        least = max(least, min(1.0, (len(p_values) - rank) * p_values[n]))
        corrected[n] = least
    return corrected
