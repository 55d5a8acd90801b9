"""Roads whose type changes: their lane sections are divided there."""

from __future__ import annotations

from itertools import pairwise

import pyarrow.compute as pc
import pytest

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.cut_sections import with_sections_cut
from tests.formats.maps import checks, lanelets, values
from tests.formats.opendrive.signal_text import WIDTH, signal
from tests.formats.opendrive.xodr import LINE, geometry, lane, load, road, section, xodr


def typed(*types: tuple[float, str]) -> str:
    """Return `<type>` elements: from this station, this type."""
    return "".join(f'<type s="{s}" type="{kind}"/>' for s, kind in types)


def linked(number: int, before: int | None = None, after: int | None = None, inside: str = WIDTH) -> str:
    """Return a lane that continues these lanes."""
    ends = {"predecessor": before, "successor": after}
    link = "".join(f'<{end} id="{target}"/>' for end, target in ends.items() if target is not None)
    return lane(number, f"<link>{link}</link>{inside}")


@pytest.mark.parametrize(
    ("types", "stretches"),
    [
        ((), [("1.0.-1", 0, 100, None)]),
        (((0, "town"),), [("1.0.-1", 0, 100, "town")]),
        (((0, "town"), (40, "town")), [("1.0.-1", 0, 100, "town")]),
        (((0, "town"), (90, "motorway")), [("1.0.-1", 0, 90, "town"), ("1.1.-1", 90, 100, "motorway")]),
        (((20, "town"),), [("1.0.-1", 0, 20, None), ("1.1.-1", 20, 100, "town")]),
        (((0, "unknown"), (20, "town")), [("1.0.-1", 0, 20, None), ("1.1.-1", 20, 100, "town")]),
        (((0, "unknown"),), [("1.0.-1", 0, 100, None)]),
        # stretches of less than a metre: at an end, and between two others
        (((0, "town"), (0.9, "rural")), [("1.0.-1", 0, 100, "rural")]),
        (((0, "town"), (99.5, "rural")), [("1.0.-1", 0, 100, "town")]),
        (((0, "town"), (50, "motorway"), (50.5, "town")), [("1.0.-1", 0, 100, "town")]),
        (
            ((0, "town"), (50, "motorway"), (50.5, "rural")),
            [("1.0.-1", 0, 50.5, "town"), ("1.1.-1", 50.5, 100, "rural")],
        ),
    ],
)
def test_a_lane_is_divided_where_the_type_of_its_road_changes(
    types: tuple[tuple[float, str], ...], stretches: list[tuple[str, float, float, str | None]]
) -> None:
    environment = load(road(lanes=section(0, lane(-1)), more=typed(*types)))
    found = lanelets(environment)
    stations = {name: values(environment, "lane_point", "road_s_m", lanelet_id=name, digits=3) for name in found}
    assert [(name, min(s), max(s), found[name]["road_type"]) for name, s in stations.items()] == stretches
    pairs = [(a[0], b[0]) for a, b in pairwise(stretches)]
    assert values(environment, "lane_link", "from_id to_id") == pairs


def test_the_parts_of_a_section_are_lanes_of_their_own_numbers() -> None:
    """The sections 0 and 1 of two ways meet at 50 m; the type changes at 20 m and at 70 m. Numbers 2 and 3 follow the last."""
    lanes = section(0, linked(1, after=1), linked(-1, after=-1), lane(-2)) + section(
        50, linked(1, before=1), linked(-1, before=-1)
    )
    environment = load(road(lanes=lanes, more=typed((0, "rural"), (20, "town"), (70, "rural"))))
    assert values(environment, "lane_link", "from_id to_id") == [
        ("1.0.-1", "1.2.-1"), ("1.0.-2", "1.2.-2"), ("1.1.-1", "1.3.-1"), ("1.1.1", "1.2.1"), ("1.2.-1", "1.1.-1"),
        ("1.2.1", "1.0.1"), ("1.3.1", "1.1.1"),
    ]  # fmt: skip
    found = lanelets(environment)
    assert {n: (row["section"], row["left_id"], row["road_type"]) for n, row in found.items() if n.endswith("-1")} == {
        "1.0.-1": (0, "1.0.1", "rural"), "1.2.-1": (2, "1.2.1", "town"), "1.1.-1": (1, "1.1.1", "town"),
        "1.3.-1": (3, "1.3.1", "rural"),
    }  # fmt: skip
    assert checks(environment) == {"handedness_default": [None]}


def test_sides_that_are_divided_differently_share_the_numbers_of_their_parts() -> None:
    lanes = section(0, linked(1), linked(-1, after=-1)) + section(
        50, linked(-1, before=-1), attributes='singleSide="true"'
    )
    environment = load(road(lanes=lanes, more=typed((0, "rural"), (20, "town"))))
    assert values(environment, "lane_link", "from_id to_id") == [
        ("1.0.-1", "1.2.-1"), ("1.2.-1", "1.1.-1"), ("1.2.1", "1.0.1"),
    ]  # fmt: skip
    assert {name: row["left_id"] for name, row in lanelets(environment).items()} == {
        "1.0.1": "1.0.-1", "1.0.-1": "1.0.1", "1.2.1": "1.1.-1", "1.2.-1": "1.2.1", "1.1.-1": "1.2.1",
    }  # fmt: skip


def test_roads_join_at_the_outer_parts_of_their_sections() -> None:
    join = '<{} elementType="road" elementId="{}" contactPoint="{}"/>'
    environment = load(
        road(lanes=section(0, linked(-1, after=-1)), more=typed((0, "rural"), (60, "town")), link=join.format("successor", 2, "start")),
        road(
            "2", LINE.replace('x="0"', 'x="100"'), section(0, linked(-1, before=-1)), more=typed((0, "town"), (60, "rural")),
            link=join.format("predecessor", 1, "end"),
        ),
    )  # fmt: skip
    assert values(environment, "lane_link", "from_id to_id") == [
        ("1.0.-1", "1.1.-1"), ("1.1.-1", "2.0.-1"), ("2.0.-1", "2.1.-1"),
    ]  # fmt: skip


def test_marks_limits_and_signs_are_those_of_the_undivided_lane() -> None:
    """The width grows from 20 m, the mark changes at 30 m, the limit at 60 m, and signs stand at 50 m, where the type changes."""
    inside = (
        '<width sOffset="0" a="3"/><width sOffset="20" a="3" b="0.01"/><roadMark sOffset="0" type="solid"/>'
        '<roadMark sOffset="30" type="broken"/><speed sOffset="0" max="9"/><speed sOffset="60" max="8"/>'
    )
    signs = signal(50, type="206") + signal(50, "-", type="205")
    more = f"{typed((0, 'rural'), (50, 'town'))}<signals>{signs}</signals>"
    environment = load(road(lanes=section(0, lane(1), lane(-1, inside)), more=more))
    assert values(environment, "lane_boundary", "lanelet_id s_start_m s_end_m marking", side="right", digits=2) == [
        ("1.0.-1", 0, 30, "solid"), ("1.0.-1", 30, 50, "broken"), ("1.0.1", 0, 50, None), ("1.1.-1", 0, 50, "broken"),
        ("1.1.1", 0, 50, None),
    ]  # fmt: skip
    assert values(environment, "speed_limit", "lanelet_id s_start_m s_end_m limit_mps", digits=2) == [
        ("1.0.-1", 0, 50, 9), ("1.1.-1", 0, 10, 9), ("1.1.-1", 10, 50, 8),
    ]  # fmt: skip
    assert values(environment, "traffic_signal", "kind lanelet_id lane_s_m", digits=2) == [
        ("stop", "1.1.-1", 0), ("give_way", "1.1.1", 50),
    ]  # fmt: skip
    half = values(environment, "lane_point", "half_width_m", lanelet_id="1.1.-1", digits=3)
    assert (half[0], half[-1]) == (1.65, 1.9)


def test_the_parts_are_those_of_a_section_that_is_cut_by_hand() -> None:
    """On a bend whose lanes grow wider, with marks, limits, signs and objects."""
    inside = (
        '<width sOffset="0" a="3"/><width sOffset="20" a="3" b="0.01"/><roadMark sOffset="0" type="solid"/>'
        '<roadMark sOffset="30" type="broken"/><speed sOffset="0" max="9"/><speed sOffset="60" max="8"/>'
    )
    zebra = '<object id="z" s="50" t="0" type="crosswalk" length="4" width="9"/>'
    signs = signal(50, type="206") + signal(20, "-", type="274", value="30", unit="km/h", id="8")
    more = f"{typed((0, 'rural'), (50, 'town'))}<signals>{signs}</signals><objects>{zebra}</objects>"
    bend = geometry('<arc curvature="0.01"/>')
    text = xodr(road(geometry=bend, lanes=section(0, lane(1), lane(-1, inside), lane(-2)), more=more))
    divided, cut = (
        load_map(MapSource("m.xodr", each.encode()), handedness="rht") for each in (text, with_sections_cut(text))
    )
    for name, table in divided.tables.items():
        own = {"environment_id", "sha256"}.intersection(table.schema.names)  # they depend on the bytes of the text
        expected, found = (tables[name].drop(own) for tables in (cut.tables, divided.tables))
        assert found == expected, name
    assert pc.count_distinct(divided.tables["lanelet"]["road_type"]).as_py() == 2
