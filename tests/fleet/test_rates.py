"""Rates: what counts as what, by hand; their intervals against scipy's; and that they cover the truth in seeded fleets."""

from __future__ import annotations

from math import inf
from typing import Any

import duckdb
import numpy as np
import pyarrow as pa
import pytest

from drivelint.errors import UsageError
from drivelint.fleet import intervals
from drivelint.fleet.rates import Rate, rates
from tests.fleet import audits
from tests.fleet.audits import drive_finding, drive_verdict, ego_drive
from tests.report.synthetic import drive, rule

ROOM = rule(profiles=[])


def rates_of(
    drives: list[Any], verdicts: list[Any], findings: list[Any], by: str | None = None, rules: Any = (ROOM,)
) -> list[Rate]:
    with duckdb.connect() as con:
        audits.add_rows(con, drives, verdicts, findings, list(rules))
        return rates(con, by)


def only(drives: list[Any], verdicts: list[Any], findings: list[Any]) -> Rate:
    (rate,) = rates_of(drives, verdicts, findings)
    return rate


def test_findings_and_exposure_of_wholly_judged_drives() -> None:
    rate = only(
        [ego_drive("a"), ego_drive("b")],
        [
            drive_verdict("a", "fail"),
            drive_verdict("a", "pass"),
            drive_verdict("b", "not_applicable", n_expected=0, n_judged=0),
        ],
        [drive_finding("a"), drive_finding("a", occurrence=1)],
    )
    assert (rate.findings, rate.km, rate.hours, rate.egos_judged, rate.egos_failed) == (2, 200, 4, 2, 1)
    assert (rate.per_100km.rate, rate.per_hour.rate) == (1.0, 0.5)
    assert (rate.per_occasion.rate, rate.occasions, rate.per_ego.rate) == (0.5, 2, 0.5)


@pytest.mark.parametrize(
    "beside",
    [drive_verdict("b", "unknown"), drive_verdict("b", "error"), drive_verdict("b", "fail", n_expected=5, n_judged=4)],
    ids=lambda row: str(row["verdict"]),
)
def test_a_drive_that_is_not_wholly_judged_stands_beside(beside: dict[str, Any]) -> None:
    """With a finding or without: else the outcome would decide what is counted."""
    rate = only(
        [ego_drive("a"), ego_drive("b", km=50.0)],
        [drive_verdict("a", "pass"), drive_verdict("b", "pass"), drive_verdict("b", "fail"), beside],
        [drive_finding("b")],
    )
    assert (rate.findings, rate.km, rate.findings_of_unknown, rate.km_unknown, rate.egos_unknown) == (0, 100, 1, 50, 1)
    assert (rate.per_100km.rate, rate.per_100km.low) == (0.0, 0.0)
    assert rate.at_least_per_100km == pytest.approx(0.0253178 / 1.5), "one finding in 150 km, Garwood's lower limit"
    assert (rate.occasions, rate.occasions_failed) == (3, 1), (
        "an occasion that was wholly judged is one, wherever it is"
    )
    assert rate.occasions_partly == (beside["verdict"] == "fail")


def test_only_the_automated_drivers_way_counts() -> None:
    assert only([ego_drive("a", engaged_km=30.0)], [drive_verdict("a", "pass")], []).km == 30
    assert only([ego_drive("a", engaged_km=0.0)], [drive_verdict("a", "unknown")], []).km_unknown == 100, (
        "it may be all of it"
    )


@pytest.mark.parametrize("code", ["other_nation", "not_engaged", "outside_conditions"])
def test_a_drive_in_which_the_rule_was_never_in_force_is_no_exposure(code: str) -> None:
    rate = only([ego_drive("a")], [drive_verdict("a", "not_applicable", reason_code=code)], [])
    assert (rate.km, rate.km_unknown, rate.egos_outside, rate.egos_judged) == (0, 0, 1, 0)
    assert rate.per_100km == (None, 0.0, inf), "without exposure nothing is known"
    assert rate.at_least_per_100km is None


def test_a_drive_that_could_not_be_judged_is_counted_and_has_no_way() -> None:
    lost = drive("lost", status="not_judged", sha256=None, tags={"release": "b"})
    by_release = rates_of([ego_drive("a"), lost], [drive_verdict("a", "pass")], [], by="release")
    assert [(r.tag_value, r.egos_judged, r.drives_not_judged, r.km) for r in by_release] == [
        ("a", 1, 0, 100),
        ("b", 0, 1, 0),
    ]


def test_a_log_that_is_there_twice_was_driven_once() -> None:
    twice = [ego_drive("a", sha256="same"), ego_drive("b", sha256="same", tags={"release": "b"})]
    words = [drive_verdict("a", "fail"), drive_verdict("b", "fail")]
    findings = [drive_finding("a"), drive_finding("b")]
    assert [(r.findings, r.km) for r in rates_of(twice, words, findings)] == [(1, 100)]
    assert [(r.tag_value, r.km) for r in rates_of(twice, words, findings, by="release")] == [("a", 100), ("b", 100)]


def test_a_verdict_without_profile_stands_for_all_profiles() -> None:
    rows = rates_of(
        [ego_drive("a"), ego_drive("b")],
        [
            drive_verdict("a", "pass", profile="nominal"),
            drive_verdict("a", "pass", profile="relaxed"),
            drive_verdict("b", "unknown"),
        ],
        [],
        rules=[rule(profiles=["nominal", "relaxed"])],
    )
    assert [(r.profile, r.km, r.km_unknown) for r in rows] == [("nominal", 100, 100), ("relaxed", 100, 100)]


def test_a_drive_without_the_tag_has_no_value_and_a_tag_of_none_is_refused() -> None:
    drives = [ego_drive("a"), ego_drive("b", tags={})]
    rows = rates_of(drives, [drive_verdict("a", "pass"), drive_verdict("b", "pass")], [], by="release")
    assert [r.tag_value for r in rows] == [None, "a"]
    with pytest.raises(UsageError, match="did you mean 'release'"):
        rates_of(drives, [], [], by="releases")


def test_a_tag_is_bound_and_a_condition_of_the_drive_is_a_tag_too() -> None:
    wet = [{"condition": "weather", "value": "wet", "source": "env"}]
    rows = rates_of([ego_drive("a", conditions=wet)], [drive_verdict("a", "pass")], [], by="weather")
    assert [r.tag_value for r in rows] == ["wet"]
    with pytest.raises(UsageError):
        rates_of([ego_drive("a")], [], [], by="x'] OR true --")


def test_measured_situations_are_tags() -> None:
    (slow, fast) = rates_of(
        [ego_drive("a", km=20.0, n_states=90, n_steps=9), ego_drive("b", km=200.0, n_states=9, n_steps=9)],
        [drive_verdict("a", "pass"), drive_verdict("b", "pass")], [], by="speed_band",
    )  # fmt: skip
    assert (slow.tag_value, fast.tag_value) == ("0 to 15 km/h", "90 km/h and more")


def test_an_ego_without_steps_is_counted_and_has_no_way() -> None:
    rate = only(
        [ego_drive("a"), drive("b", sha256="b")],
        [drive_verdict("a", "pass"), drive_verdict("b", "unknown", ego_id="")],
        [],
    )
    assert (rate.egos_judged, rate.egos_unknown, rate.km, rate.km_unknown, rate.n_unknown) == (1, 1, 100, 0, 1)


def test_possible_findings_are_told() -> None:
    rate = only(
        [ego_drive("a")],
        [drive_verdict("a", "fail")],
        [
            drive_finding("a", n_copies=100, n_stays=94),
            drive_finding("a", n_copies=100, n_stays=95),
            drive_finding("a"),
        ],
    )
    assert (rate.findings, rate.findings_possible) == (3, 1)


@pytest.mark.parametrize("n", [0, 1, 3, 40, 412])
def test_intervals_are_the_exact_ones(n: int) -> None:
    """Against scipy's own distributions: at each end of the interval what was seen has a chance of 2.5 %."""
    from scipy.stats import binomtest, poisson

    rate, low, high = intervals.poisson_rate(n, 2.0)
    assert rate == n / 2
    assert poisson.cdf(n, 2 * high) == pytest.approx(0.025)
    assert (poisson.sf(n - 1, 2 * low) == pytest.approx(0.025)) if n else (low == 0)
    exact = binomtest(n, 412).proportion_ci(0.95, method="exact")
    assert intervals.binomial_rate(n, 412)[1:] == pytest.approx((exact.low, exact.high))
    assert intervals.binomial_rate(0, 0) == (None, 0.0, 1.0)


FLEETS, DRIVES = 1000, 12


@pytest.fixture(scope="module")
def seeded() -> Any:
    """The rates of seeded fleets, one per value of a tag, their true rates per km and per occasion, and if the outcome decided.

    Each drive has ten stretches; each stretch is unseen with a chance of 4 %, whatever happens in it. A verdict of the whole drive is
    unknown if a stretch is unseen and none of the others has a failure, as the engine has it; else it is judged in part.
    """
    rng = np.random.default_rng(16)
    shape = (FLEETS, DRIVES)
    true_km, true_occasion = rng.uniform(0.001, 0.05, FLEETS), rng.uniform(0.02, 0.5, FLEETS)
    km = rng.uniform(5, 80, shape)
    events = rng.poisson((true_km[:, None] * km / 10)[:, :, None], (*shape, 10))
    unseen = rng.random((*shape, 10)) < 0.04
    seen = np.where(unseen, 0, events).sum(2)
    n_occasions = rng.integers(0, 8, shape)
    failed = rng.binomial(n_occasions, true_occasion[:, None])
    flat = {"fleet": np.repeat(np.arange(FLEETS), DRIVES), "km": km.ravel(), "n_expected": np.full(km.size, 10)}
    flat |= {
        "n_judged": 10 - unseen.sum(2).ravel(),
        "found": seen.ravel(),
        "n": n_occasions.ravel(),
        "failed": failed.ravel(),
    }
    with duckdb.connect() as con:
        audits.add_rows(con, [], [], [], [rule("by-km", profiles=[]), rule("by-occasion", profiles=[])])
        con.register("flat", pa.table(flat))
        con.execute("""
            CREATE TABLE made AS SELECT *, (row_number() OVER ())::VARCHAR AS key FROM flat;
            INSERT INTO drives BY NAME SELECT key, key AS drive_id, key AS file_name, key AS sha256, 'judged' AS status, 1 AS n_egos,
                [{'ego_id': '1', 'km': km, 'hours': km / 50, 'engaged_km': km, 'engaged_hours': km / 50, 'n_steps': 10}] AS exposure,
                [] AS conditions, MAP {'fleet': fleet::VARCHAR} AS tags FROM made;
            INSERT INTO verdicts BY NAME SELECT key, key AS drive_id, '1' AS ego_id, 'by-km' AS rule_id, n_expected, n_judged,
                CASE WHEN found > 0 THEN 'fail' WHEN n_judged < n_expected THEN 'unknown' ELSE 'pass' END AS verdict FROM made;
            INSERT INTO verdicts BY NAME SELECT key, key AS drive_id, '1' AS ego_id, 'by-occasion' AS rule_id, 1 AS n_expected,
                1 AS n_judged, CASE WHEN no < failed THEN 'fail' ELSE 'pass' END AS verdict
                FROM (SELECT *, unnest(range(n)) AS no FROM made);
            INSERT INTO findings BY NAME SELECT key, key AS drive_id, '1' AS ego_id, 'by-km' AS rule_id
                FROM (SELECT *, unnest(range(found)) FROM made);
        """)
        kept = (seen > 0) | ~unseen.any(2)
        return rates(con, "fleet"), true_km, true_occasion, (seen[kept].sum(), (true_km[:, None] * km)[kept].sum())


@pytest.mark.ci
def test_intervals_cover_the_true_rate(seeded: Any) -> None:
    found, true_km, true_occasion, _ = seeded
    per_km = [r for r in found if r.rule_id == "by-km"]
    truth = {str(n): (true_km[n], true_occasion[n]) for n in range(FLEETS)}
    covered = [r.per_100km.low <= 100 * truth[r.tag_value][0] <= r.per_100km.high for r in per_km]
    assert len(covered) == FLEETS
    assert np.mean(covered) >= 0.95
    hours = [r.per_hour.low <= 50 * truth[r.tag_value][0] <= r.per_hour.high for r in per_km]
    assert np.mean(hours) >= 0.95
    occasions = [
        r.per_occasion.low <= truth[r.tag_value][1] <= r.per_occasion.high for r in found if r.rule_id == "by-occasion"
    ]
    assert np.mean(occasions) >= 0.95
    assert np.mean([(r.at_least_per_100km or 0) <= 100 * truth[r.tag_value][0] for r in per_km]) >= 0.975


@pytest.mark.ci
def test_the_rate_has_no_bias_though_one_finding_decides_and_a_pass_needs_every_step(seeded: Any) -> None:
    """The mean of the estimates is the truth; that of the other ways to count is not, so this test can tell them apart."""
    found, true_km, _, (events_if_outcome_decides, expected_if_outcome_decides) = seeded
    per_km = [r for r in found if r.rule_id == "by-km"]
    expected = sum(true_km[int(r.tag_value)] * r.km for r in per_km)
    events, beside = sum(r.findings for r in per_km), sum(r.findings_of_unknown for r in per_km)
    near = 3 * expected**0.5
    assert abs(events - expected) < near
    all_ways = sum(true_km[int(r.tag_value)] * (r.km + r.km_unknown) for r in per_km)
    assert events + beside < all_ways - near, "what is unknown counts as kept: too low"
    assert events + beside > expected + near, "the findings alone count: too high"
    assert events_if_outcome_decides > expected_if_outcome_decides + near, "the outcome decides what counts: too high"
