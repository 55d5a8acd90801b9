"""The value of a tag that the first screen names: its rate differs most from that of the others, and chance may explain it."""

from __future__ import annotations

from typing import Any

import pytest

from tests.fleet.audits import ego_drive
from tests.fleet_report.fleet_page import FleetPage, contact, words, words_of

pytestmark = pytest.mark.ci


def contacts_page(*drives: tuple[str, int, dict[str, str]], km: float = 100.0) -> FleetPage:
    """Return the page of drives with so many contacts and these tags."""
    return FleetPage(
        [ego_drive(name, km, tags=tags) for name, _, tags in drives],
        [row for name, n, _ in drives for row in words(name, "fail" if n else "pass")],
        [contact(name, k) for name, n, _ in drives for k in range(n)],
    )


def line(of: FleetPage) -> str:
    (found,) = of.html.xpath("//header/p[contains(@class, 'worst-value')]")
    return words_of(found)


def low_and_high(n: int, hundred_km: float) -> tuple[float, float]:
    """Return Garwood's interval."""
    from scipy.stats import chi2

    return chi2.ppf(0.025, 2 * n) / 2 / hundred_km if n else 0.0, chi2.ppf(0.975, 2 * n + 2) / 2 / hundred_km


def test_the_worst_site_is_named_with_rates_and_intervals_of_all_sites() -> None:
    from scipy.stats import binomtest

    sites = [("a", 30, "hull"), ("b", 2, "leeds"), ("c", 3, "york")]
    page = contacts_page(*((name, n, {"site": site, "release": "v1"}) for name, n, site in sites))
    found = page.content.worst_value
    assert found is not None
    assert [(rate.tag_value, rate.findings) for rate in found.rates] == [("hull", 30), ("york", 3), ("leeds", 2)]
    assert (found.worst.per_100km.low, found.worst.per_100km.high) == pytest.approx(low_and_high(30, 1))
    assert (found.rest.low, found.rest.high) == pytest.approx(low_and_high(5, 2))
    assert found.corrected == pytest.approx(
        3 * binomtest(30, 35, 1 / 3).pvalue
    )  # three sites; all drives have one release
    said = line(page)
    assert said.startswith(
        "By tag, the largest difference is at site hull: No collision, findings per 100 km: hull 30.0 (20.2 to 42.8)"
    )
    assert "More than chance explains" in said
    assert "leeds 2.00 (0.242 to 7.22)" in said
    assert "report --by site" in said


def test_a_difference_that_chance_explains_is_no_headline() -> None:
    page = contacts_page(("a", 3, {"site": "hull"}), ("b", 1, {"site": "york"}))
    assert page.content.worst_value is not None
    assert not page.content.worst_value.is_significant
    assert not page.html.xpath("//p[contains(@class, 'worst-value')]")


def test_of_several_tags_the_one_that_differs_most_is_named() -> None:
    drives: list[Any] = [
        (f"{site}{release}", 20 if release == "v2" else 9 if site == "hull" else 8, {"site": site, "release": release})
        for site in ("hull", "york")
        for release in ("v1", "v2")
    ]
    assert "at release v2: No collision, findings per 100 km: v2 20.0 " in line(contacts_page(*drives))


@pytest.mark.parametrize(
    "drives",
    [
        [("a", 3, {}), ("b", 1, {})],
        [("a", 3, {"site": "hull"}), ("b", 1, {"site": "hull"})],
        [("a", 0, {"site": "hull"}), ("b", 0, {"site": "york"})],
        [(f"{n}", n, {"car": f"{n}"}) for n in range(13)],
    ],
    ids=["no tags", "one value", "no findings", "too many values"],
)
def test_without_values_to_compare_nothing_is_said(drives: list[Any]) -> None:
    page = contacts_page(*drives)
    assert page.content.worst_value is None
    assert not page.html.xpath("//p[contains(@class, 'worst-value')]")


def test_a_tag_that_is_no_plain_word_is_quoted_in_the_option() -> None:
    page = contacts_page(("a", 30, {"the site": "hull"}), ("b", 1, {"the site": "york"}))
    assert "report --by 'the site'" in line(page)
