"""Cross paths of OpenDRIVE 1.8: pedestrians walk on a road across another one."""

from __future__ import annotations

from typing import Any

import pytest

from tests.formats.maps import checks, messages, rows, values
from tests.formats.opendrive.xodr import geometry, lane, load, road, section

LANES = section(0, lane(2, kind="walking"), lane(1), lane(-1), lane(-2, kind="walking"))
PATH = (
    '<crossPath id="0" crossingRoad="2" roadAtStart="{}" roadAtEnd="1"><startLaneLink s="52" from="2" to="-1"/>'
    '<endLaneLink s="52" from="-2" to="-1"/></crossPath>'
)
VIRTUAL = 'type="virtual" mainRoad="1" sStart="49" sEnd="54"'


def crossed(
    kinds: tuple[str, ...] = ("walking",),
    *,
    more: str = "",
    start_road: str = "1",
    attributes: str = VIRTUAL,
    height: str = "",
    **options: Any,
) -> Any:
    """Return the map of a road of 100 m with a path of 2 m a lane across it at 52 m, towards its right."""
    lanes = section(0, *(lane(-k, '<width sOffset="0" a="2"/>', kind) for k, kind in enumerate(kinds, 1)))
    line = geometry("<line/>", at=(52, 7, -1.5707963267948966), length=14)
    return load(
        road(lanes=LANES, more=more), road("2", line, lanes, length=14, junction="9", more=height),
        f'<junction id="9" {attributes}>{PATH.format(start_road)}</junction>', **options,
    )  # fmt: skip


def test_a_cross_path_is_a_crossing_of_unknown_kind() -> None:
    environment = crossed(offset=(5.0, 0.0))
    assert values(environment, "crossing", "crossing_id lanelet_id s_start_m s_end_m kind", digits=3) == [
        ("9/0", "1.0.-1", 50.0, 52.0, None), ("9/0", "1.0.1", 48.0, 50.0, None),
    ]  # fmt: skip
    assert rows(environment, "road_object") == []
    assert {"virtual_junction", "invalid_object"}.isdisjoint(checks(environment))


@pytest.mark.parametrize(
    ("kinds", "stretch"),
    [
        (("walking", "walking"), (48.0, 52.0)),
        (("biking", "walking"), (48.0, 50.0)),
        (("biking",), None),
        (("sidewalk",), (50.0, 52.0)),
    ],
)
def test_the_crossing_is_where_the_path_is_for_people_on_foot(
    kinds: tuple[str, ...], stretch: tuple[float, float] | None
) -> None:
    found = values(crossed(kinds), "crossing", "s_start_m s_end_m", digits=3, lanelet_id="1.0.-1")
    assert found == ([] if stretch is None else [stretch])


@pytest.mark.parametrize(("s", "names"), [("51", {"zebra"}), ("80", {"zebra", "9/0"})])
def test_a_path_that_is_drawn_as_an_object_is_one_crossing(s: str, names: set[str]) -> None:
    zebra = f'<object id="zebra" name="zebra" type="crosswalk" s="{s}" t="0" length="3" width="7"/>'
    environment = crossed(more=f"<objects>{zebra}</objects>")
    assert set(values(environment, "crossing", "crossing_id")) == names


def test_the_height_of_the_path_is_that_of_the_road_at_which_it_starts() -> None:
    """The standard disregards the elevation of the crossing road."""
    height = '<elevationProfile><elevation s="0" a="20" b="0" c="0" d="0"/></elevationProfile>'
    assert len(rows(crossed(height=height), "crossing")) == 2


def test_a_path_of_a_common_junction() -> None:
    assert len(rows(crossed(attributes=""), "crossing")) == 2


def test_a_path_of_a_road_that_does_not_exist_is_named() -> None:
    environment = crossed(start_road="7")
    assert rows(environment, "crossing") == []
    assert messages(environment, "invalid_object") == ["cross path 9/0 is left out: its road 7 does not exist"]
