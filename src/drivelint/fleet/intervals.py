"""Rates with exact 95 % confidence intervals, and how to correct several p-values at once."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Sequence

CONFIDENCE: Final = 0.95


class Estimate(NamedTuple):
    """A rate and the ends of its interval; `rate` is None where there was no exposure: then nothing is known of it."""

    rate: float | None
    low: float
    high: float


def poisson(events: int, exposure: float) -> Estimate:
    """Return events per unit of exposure, with Garwood's exact interval (1936).

    The interval holds if events occur independently of each other. Where one failure leads to several findings in a drive, it is too
    narrow; the share of the egos that failed does not have that weakness.
    """
    from scipy.special import gammaincinv

    if exposure <= 0:
        return Estimate(None, 0.0, inf)
    tail = (1 - CONFIDENCE) / 2
    low = float(gammaincinv(events, tail)) if events else 0.0
    return Estimate(events / exposure, low / exposure, float(gammaincinv(events + 1, 1 - tail)) / exposure)


def binomial(events: int, trials: int) -> Estimate:
    """Return events per trial, with the exact interval of Clopper and Pearson (1934)."""
    from scipy.special import betaincinv

    if trials <= 0:
        return Estimate(None, 0.0, 1.0)
    tail = (1 - CONFIDENCE) / 2
    low = float(betaincinv(events, trials - events + 1, tail)) if events else 0.0
    high = float(betaincinv(events + 1, trials - events, 1 - tail)) if events < trials else 1.0
    return Estimate(events / trials, low, high)


def holm(p_values: Sequence[float]) -> list[float]:
    """Return the p-values as corrected by Holm (1979), in the same order.

    If none of the differences exists, the chance that any corrected value is below 0.05 is at most 5 %, however the rules depend on
    each other. That is needed here: one event fails several rules. Benjamini and Hochberg's correction allows more false calls, the more
    true differences there are, and assumes that the tests do not depend negatively on each other.
    """
    corrected = [1.0] * len(p_values)
    least = 0.0
    for rank, n in enumerate(sorted(range(len(p_values)), key=lambda n: (p_values[n], n))):
        least = max(least, min(1.0, (len(p_values) - rank) * p_values[n]))
        corrected[n] = least
    return corrected
