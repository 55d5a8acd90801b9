"""Every geometry and every width description against the naive second reading."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree

from drivelint.formats.opendrive.planview import planview
from tests.formats.opendrive.naive import NaiveMap
from tests.formats.opendrive.xodr import checks, geometry, lane, lanelets, load, points, road, section, xodr

SPOT = (3, -2, 0.4)
SPOTS = {
    "line": geometry("<line/>", at=SPOT),
    "arc": geometry('<arc curvature="-0.02"/>', at=SPOT),
    "flat arc": geometry('<arc curvature="1e-12"/>', at=SPOT),
    "spiral": geometry('<spiral curvStart="0.0" curvEnd="0.05"/>', at=SPOT),
    "spiral through zero": geometry('<spiral curvStart="0.03" curvEnd="-0.03"/>', at=SPOT),
    "long spiral": geometry('<spiral curvStart="-0.08" curvEnd="0.1"/>', at=SPOT),
    "constant spiral": geometry('<spiral curvStart="0.01" curvEnd="0.01"/>', at=SPOT),
    "poly3": geometry('<poly3 a="0" b="0" c="0.003" d="-0.00002"/>', at=SPOT),
    "paramPoly3 by arc length": geometry(
        '<paramPoly3 pRange="arcLength" aU="0" bU="1" cU="0" dU="-0.0000004" aV="0" bV="0" cV="0.001" dV="0.000002"/>'
    ),
    "paramPoly3 normalized": geometry(
        '<paramPoly3 pRange="normalized" aU="0" bU="120" cU="-40" dU="15" aV="0" bV="0" cV="30" dV="-5"/>'
    ),
    "several": (
        geometry("<line/>", 0, length=40)
        + geometry('<arc curvature="0.02"/>', 40, (40, 0, 0), 30)
        + geometry("<line/>", 70, (68.23, 8.73, 0.6), 30)
    ),
}
PROFILE = {
    "offset": section(0, lane(1), lane(-1)),
    "widths": section(
        0,
        lane(1, '<width sOffset="0" a="0" b="0" c="0.0042" d="-0.00007"/><width sOffset="40" a="2.24"/>'),
        lane(2, '<width sOffset="0" a="2" b="0.01"/>'),
        lane(-1, '<width sOffset="0" a="3.5" b="0" c="-0.00105" d="0.000007"/>'),
        lane(-2),
    ),
    "slopes": section(
        0,
        lane(1, '<width sOffset="0" a="3" b="0.06"/>'),
        lane(2, '<width sOffset="0" a="3" b="0.03"/>'),
        lane(-1, '<width sOffset="0" a="6" b="-0.05"/>'),
    ),
    "sections": section(0, lane(1), lane(-1), lane(-2))
    + section(33.3, lane(1), lane(2), lane(-1, '<width sOffset="0" a="3" b="0.02"/><width sOffset="20" a="3.4"/>')),
}
OFFSET = (
    '<laneOffset s="0" a="0.5"/><laneOffset s="20" a="0.5" b="0" c="0.0036" d="-0.00006"/><laneOffset s="60" a="2.42"/>'
)


def deviation(text: str, rows: dict[str, list[dict[str, Any]]], *, every: int = 1) -> float:
    """Return the largest distance (m) of both bounds from the naive reading's edges."""
    naive, worst = NaiveMap(text), 0.0
    for name, line in rows.items():
        road_id, section_no, lane_no = name.rsplit(".", 2)
        start, end = naive.sections(road_id)[int(section_no)]
        for p in line[::every]:
            s = min(max(p["road_s_m"], start + 1e-6), end - 1e-6)
            inner, outer = naive.edges(road_id, int(section_no), int(lane_no), s)
            left, right = (p["left_x_m"], p["left_y_m"]), (p["right_x_m"], p["right_y_m"])
            worst = max(
                worst,
                min(
                    max(math.dist(left, inner), math.dist(right, outer)),
                    max(math.dist(left, outer), math.dist(right, inner)),
                ),
            )
            centre = ((inner[0] + outer[0]) / 2, (inner[1] + outer[1]) / 2)
            worst = max(worst, math.dist(centre, (p["x_m"], p["y_m"])))
            assert p["half_width_m"] == pytest.approx(math.dist(inner, outer) / 2, abs=1e-3)
    return worst


@pytest.mark.parametrize("shape", SPOTS)
def test_geometry_agrees_with_a_naive_reading(shape: str) -> None:
    environment = load(road(geometry=SPOTS[shape]))
    assert deviation(xodr(road(geometry=SPOTS[shape])), points(environment), every=3) < 1e-3


@pytest.mark.parametrize("profile", PROFILE)
@pytest.mark.parametrize("shape", ["arc", "spiral"])
def test_offsets_widths_and_sections_agree_with_a_naive_reading(profile: str, shape: str) -> None:
    part = road(geometry=SPOTS[shape], lanes=OFFSET + PROFILE[profile])
    assert deviation(xodr(part), points(load(part))) < 1e-3


@pytest.mark.parametrize("shape", SPOTS)
def test_chords_keep_within_a_centimetre_and_five_metres(shape: str) -> None:
    part = road(geometry=SPOTS[shape], lanes=OFFSET + PROFILE["widths"])
    naive = NaiveMap(xodr(part))
    for name, line in points(load(part)).items():
        road_id, section_no, lane_no = name.rsplit(".", 2)
        for a, b in list(pairwise(line))[::4]:
            s = (a["road_s_m"] + b["road_s_m"]) / 2
            if abs(a["road_s_m"] - b["road_s_m"]) < 0.01:
                continue
            inner, outer = naive.edges(road_id, int(section_no), int(lane_no), s)
            left, right = (inner, outer) if (int(lane_no) < 0) else (outer, inner)
            for side, edge in (("left", left), ("right", right)):
                if lanelets_along(name) < 0:
                    edge = right if side == "left" else left  # noqa: PLW2901 - seen from the other direction
                chord = ((a[f"{side}_x_m"], a[f"{side}_y_m"]), (b[f"{side}_x_m"], b[f"{side}_y_m"]))
                assert distance(edge, *chord) < 0.0105
            assert math.hypot(a["x_m"] - b["x_m"], a["y_m"] - b["y_m"]) <= 5.01


def lanelets_along(name: str) -> int:
    return 1 if int(name.rsplit(".", 1)[1]) < 0 else -1


def distance(p: tuple[float, float], a: tuple[float, float], b: tuple[float, float]) -> float:
    length = math.dist(a, b)
    if length < 1e-9:
        return math.dist(p, a)
    along = max(0.0, min(1.0, ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / length**2))
    return math.dist(p, (a[0] + along * (b[0] - a[0]), a[1] + along * (b[1] - a[1])))


def test_borders_are_edges_whatever_sign_the_writer_gives_them() -> None:
    by_width = load(road(lanes=section(0, lane(1), lane(-1), lane(-2))))
    for sign in (-1, 1):
        borders = [lane(1, '<border sOffset="0" a="3.5"/>')]
        borders += [lane(-n, f'<border sOffset="0" a="{sign * 3.5 * n}"/>') for n in (1, 2)]
        by_border = load(road(lanes=section(0, *borders)))
        a, b = (
            by_width.tables["lane_point"].drop(["environment_id"]),
            by_border.tables["lane_point"].drop(["environment_id"]),
        )
        assert a.equals(b)


def test_borders_and_widths_in_one_lane_mean_the_widths() -> None:
    both = load(road(lanes=section(0, lane(-1, '<border sOffset="0" a="-9"/><width sOffset="0" a="3"/>'))))
    assert lanelets(both)["1.0.-1"]["width_m"] == pytest.approx(3.0)


@pytest.mark.parametrize("handedness", ["rht", "lht"])
def test_a_lane_may_taper_to_nothing_at_either_end(handedness: str) -> None:
    lanes = section(
        0,
        lane(-1),
        lane(-2, '<width sOffset="0" a="0" b="0.035"/>'),
        lane(1, '<width sOffset="0" a="3.5" b="-0.035"/>'),
    )
    environment = load(road(lanes=lanes, geometry=SPOTS["arc"]), handedness=handedness)
    # the integral of w (1 - curvature t) over the stations, t in the middle of the lane
    areas = {"1.0.-2": 175 * 0.93 - 0.02 * 3.5**2 / 2 * 100 / 3, "1.0.1": 175 + 0.02 * 3.5**2 / 2 * 100 / 3}
    for name, area in areas.items():
        line = points(environment)[name]
        assert min(p["half_width_m"] for p in line) == pytest.approx(0.0, abs=1e-9)
        assert all(math.isfinite(v) for p in line for k, v in p.items() if k.endswith("_m") and v is not None)
        assert all(math.hypot(p["tx"], p["ty"]) == pytest.approx(1.0) for p in line)
        assert lanelets(environment)[name]["area_m2"] == pytest.approx(area, rel=1e-3)


@pytest.mark.parametrize("shape", [name for name in SPOTS if name != "several"])  # its joints are not smooth
def test_tangent_is_the_direction_of_the_centre_line(shape: str) -> None:
    part = road(geometry=SPOTS[shape], lanes=PROFILE["slopes"])
    naive = NaiveMap(xodr(part))

    def centre(lane_no: int, s: float) -> tuple[float, float]:
        inner, outer = naive.edges("1", 0, lane_no, s)
        return (inner[0] + outer[0]) / 2, (inner[1] + outer[1]) / 2

    for name, line in points(load(part)).items():
        lane_no = int(name.rsplit(".", 1)[1])
        for p in line[1:-1:3]:
            before, after = (centre(lane_no, p["road_s_m"] + ds * lanelets_along(name)) for ds in (-0.05, 0.05))
            way = math.atan2(after[1] - before[1], after[0] - before[0])
            turn = math.remainder(way - math.atan2(p["ty"], p["tx"]), math.tau)
            assert abs(turn) < 1e-3
        for a, b in pairwise(line):
            assert b["s_m"] - a["s_m"] == pytest.approx(math.hypot(b["x_m"] - a["x_m"], b["y_m"] - a["y_m"]))


@pytest.mark.parametrize("shape", ["poly3", "paramPoly3 normalized"])
def test_polynomials_run_one_metre_per_metre(shape: str) -> None:
    """Their parameter is not the arc length; the standard's stations are (of a curve as long as it says)."""
    s = np.linspace(1.0, 99.0, 500)
    plan = planview(etree.fromstring(f"<planView>{SPOTS[shape]}</planView>"))
    here, there = plan.evaluate(s, s), plan.evaluate(s + 1e-3, s)
    speed = np.hypot(there.x - here.x, there.y - here.y) / 1e-3
    assert np.ptp(speed) < 1e-6
    assert here.speed == pytest.approx(speed, rel=1e-6)


def test_a_width_that_steps_keeps_its_step() -> None:
    part = road(lanes=section(0, lane(-1, '<width sOffset="0" a="3"/><width sOffset="50" a="4"/>')))
    environment = load(part)
    line = points(environment)["1.0.-1"]
    narrow = [p for p in line if p["road_s_m"] < 50]
    assert {round(p["half_width_m"], 6) for p in narrow} == {1.5}
    assert {round(p["half_width_m"], 6) for p in line if p["road_s_m"] >= 50} == {2.0}
    assert checks(environment)["edge_step"] == ["1"]


def test_elevation_is_z_and_unknown_without_a_profile() -> None:
    climb = '<elevationProfile><elevation s="0" a="2" b="0.1" c="0" d="0"/></elevationProfile>'
    line = points(load(road(more=climb)))["1.0.-1"]
    assert [p["z_m"] for p in line] == pytest.approx([2 + 0.1 * p["road_s_m"] for p in line])
    assert {p["z_m"] for p in points(load())["1.0.-1"]} == {None}


def test_all_lanes_of_a_section_share_their_stations() -> None:
    environment = load(road(geometry=SPOTS["arc"], lanes=OFFSET + PROFILE["widths"]))
    stations = {tuple(sorted(p["road_s_m"] for p in line)) for line in points(environment).values()}
    assert len(stations) == 1
    assert {0.0, 20.0, 40.0, 60.0, 100.0} <= set(stations.pop())


def test_what_does_not_fit_is_reported() -> None:
    gap = geometry("<line/>", length=50) + geometry("<line/>", 50, (51, 0, 0.5), 50)
    environment = load(
        road(geometry=gap, length=120, lanes=section(0, lane(-1), lane(-2, '<width sOffset="0" a="1" b="-0.02"/>')))
    )
    assert {"reference_gap", "reference_kink", "length_mismatch", "negative_width"} <= checks(environment).keys()
    assert max(p["road_s_m"] for p in points(environment)["1.0.-1"]) == 100.0


def test_a_hole_between_geometries_is_bridged_straight_on_and_reported() -> None:
    spiral = geometry('<spiral curvStart="0" curvEnd="0.1"/>', length=20)
    hole = spiral + geometry("<line/>", 60, (200, 0, 0), 40)
    environment = load(road(geometry=hole))
    assert checks(environment)["reference_gap"] == ["1"]
    bridge = [p for p in points(environment)["1.0.-1"] if 20 <= p["road_s_m"] < 60]
    assert {round(math.atan2(p["ty"], p["tx"]), 6) for p in bridge} == {1.0}


def test_a_bend_tighter_than_its_lane_is_reported_and_finite() -> None:
    tight = '<geometry s="0" x="0" y="0" hdg="0" length="6"><arc curvature="-0.5"/></geometry>'
    environment = load(road(geometry=tight, length=6, lanes=section(0, lane(-1, '<width sOffset="0" a="6"/>'))))
    assert checks(environment)["folded_lane"] == ["1.0.-1"]
    assert all(math.isfinite(v) for p in points(environment)["1.0.-1"] for k, v in p.items() if isinstance(v, float))


@settings(max_examples=25, deadline=None)
@given(st.floats(-0.08, 0.08), st.floats(-0.08, 0.08), st.floats(5, 80), st.floats(-3, 3))
def test_any_spiral_agrees_with_a_naive_reading(first: float, last: float, length: float, heading: float) -> None:
    shape = f'<spiral curvStart="{first}" curvEnd="{last}"/>'
    spiral = geometry(shape, at=(10, 20, heading), length=length)
    part = road(geometry=spiral, length=length)
    assert deviation(xodr(part), points(load(part)), every=5) < 1e-3
