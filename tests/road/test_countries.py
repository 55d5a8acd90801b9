"""The country that a code means."""

from __future__ import annotations

import pytest

from drivelint.road.countries import nation_of, only_nation, side_of_nation


@pytest.mark.parametrize(
    ("code", "nation"),
    [
        ("DEU", "de"), ("de", "de"), (276, "de"), ("GBR", "gb"), ("UK", "gb"), ("USA", "us"), ("SGP", "sg"), (" se ", "se"),
        ("ZAM", None), ("OpenDRIVE", None), ("", None), (None, None), (0, None),
    ],
)  # fmt: skip
def test_a_code(code: str | int | None, nation: str | None) -> None:
    assert nation_of(code) == nation


def test_one_country_of_all() -> None:
    assert only_nation(["OpenDRIVE", "DE", "DEU", None]) == "de"
    assert only_nation(["DE", "GB"]) is None
    assert only_nation([]) is None


def test_the_side() -> None:
    assert [side_of_nation(nation) for nation in ("gb", "sg", "jp", "de", "us")] == ["lht", "lht", "lht", "rht", "rht"]
