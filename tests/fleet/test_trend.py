"""The test of a trend: equal to the binomial test of two steps, to all outcomes counted one by one, and to chance where nothing changes."""

from __future__ import annotations

from itertools import product
from math import factorial, prod

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drivelint.fleet import trend
from drivelint.fleet.trend import trend_p_value

EXPOSURES = st.floats(0.5, 50)


@given(st.lists(st.integers(0, 40), min_size=2, max_size=2), st.tuples(EXPOSURES, EXPOSURES))
def test_of_two_audits_it_is_the_binomial_test(events: list[int], exposures: tuple[float, float]) -> None:
    from scipy.stats import binomtest  # a second of every worker's collecting

    expected = binomtest(events[1], sum(events), exposures[1] / sum(exposures)).pvalue if sum(events) else 1.0
    assert trend_p_value(events, exposures) == pytest.approx(expected, rel=1e-6)


def counted_one_by_one(events: list[int], exposures: list[float]) -> float:
    """Return the p-value from all ways to spread the events over the steps, each with its multinomial chance."""
    n, shares = sum(events), [each / sum(exposures) for each in exposures]
    chances: dict[int, float] = {}
    for way in product(range(n + 1), repeat=len(events)):
        if sum(way) == n:
            chance = factorial(n) * prod(share**k / factorial(k) for share, k in zip(shares, way, strict=True))
            score = sum(step * k for step, k in enumerate(way))
            chances[score] = chances.get(score, 0.0) + chance
    observed = chances[sum(step * k for step, k in enumerate(events))]
    return sum(chance for chance in chances.values() if chance <= observed * (1 + 1e-7))


@given(st.lists(st.tuples(st.integers(0, 3), EXPOSURES), min_size=3, max_size=4))
def test_it_counts_every_outcome(steps: list[tuple[int, float]]) -> None:
    events, exposures = [n for n, _ in steps], [of for _, of in steps]
    assert trend_p_value(events, exposures) == pytest.approx(counted_one_by_one(events, exposures), rel=1e-6)


@given(st.lists(st.tuples(st.integers(0, 30), EXPOSURES), min_size=2, max_size=6), st.floats(0.01, 100))
def test_neither_the_unit_of_the_exposure_nor_the_direction_of_time_matters(
    steps: list[tuple[int, float]], unit: float
) -> None:
    events, exposures = [n for n, _ in steps], [of for _, of in steps]
    expected = trend_p_value(events, exposures)
    assert trend_p_value(events, [unit * of for of in exposures]) == pytest.approx(expected, rel=1e-5)
    assert trend_p_value(events[::-1], exposures[::-1]) == pytest.approx(expected, rel=1e-5)


def test_many_events_have_nearly_the_exact_value(monkeypatch: pytest.MonkeyPatch) -> None:
    events, exposures = [130, 110, 100, 95], [1.0, 1.0, 1.0, 1.0]
    exact = trend_p_value(events, exposures)
    monkeypatch.setattr(trend, "MAX_EXACT_EVENTS", 0)
    assert trend_p_value(events, exposures) == pytest.approx(exact, rel=0.02)


def test_false_calls_are_as_rare_as_the_level_says() -> None:
    rng = np.random.Generator(np.random.PCG64(7))
    exposures = [10.0, 20.0, 5.0, 15.0]
    values = [trend_p_value(rng.poisson(np.array(exposures) * 0.6).tolist(), exposures) for _ in range(2000)]
    assert 0.02 < np.mean(np.array(values) <= 0.05) <= 0.055
